// The SPD's generators against its tables: counts, cameras, lights, shapes, and how far they grow.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <gtest/gtest.h>

#include "scenes/catalogue.hpp"

namespace beambench::scenes {
namespace {

struct Count {
  std::int64_t spheres;
  std::int64_t cones;
  std::int64_t polygons;
  std::int64_t total() const { return spheres + cones + polygons; }
};

std::int64_t power(std::int64_t base, std::int64_t exponent) {
  return exponent == 0 ? 1 : base * power(base, exponent - 1);
}

/// The formulas of the SPD's table.
const std::map<std::string, std::function<Count(std::int64_t)>>& formulas() {
  static const std::map<std::string, std::function<Count(std::int64_t)>> all = {
      {"balls",
       [](auto n) {
         return Count{(power(9, n + 1) - 1) / 8, 0, 1};
       }},
      {"gears",
       [](auto n) {
         return Count{0, 0, 2 * n * n * n + 144 * n * n * n + 1};
       }},
      {"jacks",
       [](auto n) {
         return Count{6 * (power(8, n) - 1) / 7, 3 * (power(8, n) - 1) / 7, 0};
       }},
      {"lattice",
       [](auto n) {
         return Count{power(n + 1, 3), 3 * n * (n + 1) * (n + 1), 0};
       }},
      {"mount",
       [](auto n) {
         return Count{4, 0, 2 * power(4, n)};
       }},
      {"rings",
       [](auto n) {
         const std::int64_t each = 5 * n * (n + 1) * (2 * n + 1);
         return Count{each, each, 1};
       }},
      {"shells",
       [](auto n) {
         return Count{180 * power(2, n) + 1, 0, 0};
       }},
      {"sombrero",
       [](auto n) {
         return Count{0, 0, 2 * power(32 * power(2, n - 1) - 1, 2)};
       }},
      {"teapot",
       [](auto n) {
         return Count{0, 0, 64 * n * n - 8 * n + n * n};
       }},
      {"tetra",
       [](auto n) {
         return Count{0, 0, power(4, n)};
       }},
      {"tree", [](auto n) {
         return Count{power(2, n + 1) - 1, power(2, n + 1) - 1, 1};
       }}};
  return all;
}

const SceneInfo& info_of(const std::string& name) {
  const auto catalogue = scene_catalogue();
  return *std::find_if(catalogue.begin(), catalogue.end(),
                       [&](const SceneInfo& info) { return info.name == name; });
}

std::int64_t smallest(const std::string& name) {
  return static_cast<std::int64_t>(info_of(name).parameters.at(0).minimum);
}

TEST(Spd, CountsFollowTheFormulas) {
  for (const auto& [name, formula] : formulas()) {
    for (const std::int64_t n : {1, 2, 3, 4, 5}) {
      const Count expected = formula(n);
      if (n < smallest(name) || expected.total() > 100000) continue;
      const Scene scene = load_scene(name + ":n=" + std::to_string(n));
      EXPECT_EQ(scene.spheres.size(), expected.spheres) << name << n;
      EXPECT_EQ(scene.cones.size(), expected.cones) << name << n;
      EXPECT_EQ(scene.polygons.size(), expected.polygons) << name << n;
      EXPECT_EQ(scene.primitives.size(), expected.total()) << name << n;
    }
  }
}

// At size 1, four of the 56 triangles of the SPD's teapot are degenerate, which our scenes do not
// allow. The SPD's own program warns about this size.
TEST(Spd, OnlyTheTeapotStartsAtSizeTwo) {
  for (const auto& [name, formula] : formulas()) {
    EXPECT_EQ(std::max<std::int64_t>(smallest(name), 1), name == "teapot" ? 2 : 1) << name;
  }
}

TEST(Spd, DefaultsAreThoseOfTheTable) {
  const std::map<std::string, std::string> defaults = {
      {"balls", "4"}, {"tetra", "6"},    {"shells", "5"},  {"teapot", "12"},
      {"gears", "4"}, {"mount", "6"},    {"rings", "7"},   {"tree", "11"},
      {"jacks", "1"}, {"lattice", "12"}, {"sombrero", "1"}};
  for (const auto& [name, n] : defaults) {
    EXPECT_EQ(info_of(name).parameters.at(0).default_value, n) << name;
  }
}

TEST(Spd, EveryGeneratorGrowsToTenMillionPrimitives) {
  for (const auto& [name, formula] : formulas()) {
    const auto largest = static_cast<std::int64_t>(info_of(name).parameters.at(0).maximum);
    EXPECT_GE(formula(largest).total(), 10'000'000) << name << ":n=" << largest;
  }
  for (const auto& [name, parameter] : {std::pair{"bumpy", 0}, std::pair{"escena1", 1}}) {
    EXPECT_GE(info_of(name).parameters.at(static_cast<std::size_t>(parameter)).maximum, 1e7)
        << name;
  }
}

struct View {
  const char* name;
  glm::vec3 from;
  glm::vec3 at;
  glm::vec3 up;
  float angle;
  int size;
  std::size_t lights;
};

TEST(Spd, ViewsAreThoseOfTheTable) {
  const glm::vec3 z(0, 0, 1);
  const glm::vec3 o(0);
  const std::array<View, 9> views = {{
      {"shells", {-6, -60, 35}, {0, 8, -15}, z, 45, 512, 1},
      {"teapot", {4.86F, 7.2F, 5.4F}, o, z, 45, 512, 2},
      {"gears", {-1.1F, -2.1F, 2.6F}, o, z, 45, 512, 5},
      {"mount", {-1.6F, 1.6F, 1.7F}, o, z, 45, 512, 1},
      {"rings", {-1, -2.6131F, 0.5F}, {-1, -1.6131F, 0.5F}, z, 45, 512, 3},
      {"tree", {4.5F, 0.4F, 2}, {0, 0, 1.5F}, z, 45, 512, 7},
      {"jacks", {0, 0, -8}, o, {0, 1, 0}, 25, 256, 1},
      {"lattice",
       {6.5F / 12, 1, 23.0F / 24},
       {6.5F / 12, -1, -25.0F / 24},
       {0.2F, 1, 0},
       60,
       512,
       6},
      {"sombrero", {0, 5, -8}, o, z, 40, 512, 1},
  }};
  for (const View& view : views) {
    const Scene scene = load_scene(view.name);
    const Camera& camera = scene.cameras.at(0);
    EXPECT_LT(glm::distance(camera.from, view.from), 1e-4F) << view.name;
    EXPECT_LT(glm::distance(camera.at, view.at), 1e-4F) << view.name;
    EXPECT_EQ(camera.up, view.up) << view.name;
    EXPECT_EQ(camera.angle, view.angle) << view.name;
    EXPECT_EQ(camera.width, view.size) << view.name;
    EXPECT_EQ(camera.height, view.size) << view.name;
    EXPECT_EQ(scene.lights.size(), view.lights) << view.name;
    const glm::vec3 jacks(0.2F, 0.05F, 0.2F);
    EXPECT_EQ(scene.background, view.angle == 25 ? jacks : glm::vec3(0.078F, 0.361F, 0.753F))
        << view.name;
  }
}

std::vector<glm::dvec3> corners_of(const Scene& scene, const Polygon& polygon) {
  std::vector<glm::dvec3> corners;
  for (std::uint32_t i = 0; i < polygon.corner_count; ++i) {
    corners.emplace_back(scene.vertices[scene.corners[polygon.first_corner + i]]);
  }
  return corners;
}

glm::dvec3 newell_normal(const std::vector<glm::dvec3>& corners) {
  glm::dvec3 normal(0.0);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    normal += glm::cross(corners[i], corners[(i + 1) % corners.size()]);
  }
  return normal;
}

TEST(Gears, FacesAreConcaveAndLookOutward) {
  const Scene scene = load_scene("gears:n=1");
  const auto upper = corners_of(scene, scene.polygons[1]);
  const auto lower = corners_of(scene, scene.polygons[146]);
  ASSERT_EQ(upper.size(), 144U);
  ASSERT_EQ(lower.size(), 144U);
  EXPECT_GT(newell_normal(upper).z, 1.0);
  EXPECT_LT(newell_normal(lower).z, -1.0);
  int reflex = 0;
  for (std::size_t i = 0; i < 144; ++i) {
    const glm::dvec3 turn =
        glm::cross(upper[(i + 1) % 144] - upper[i], upper[(i + 2) % 144] - upper[(i + 1) % 144]);
    if (turn.z < 0.0) ++reflex;
    const auto side = corners_of(scene, scene.polygons[2 + i]);
    ASSERT_EQ(side.size(), 4U);
    const glm::dvec3 out = newell_normal(side);
    EXPECT_NEAR(out.z, 0.0, 1e-7);
    EXPECT_GT(out.x * (side[0].x + side[3].x) + out.y * (side[0].y + side[3].y), 0.0);
  }
  EXPECT_EQ(reflex, 72) << "two at the foot of each of 36 teeth";
  for (const Polygon& polygon : scene.polygons) {  // NFF: the first two edges are convex
    const auto c = corners_of(scene, polygon);
    EXPECT_GT(glm::dot(glm::cross(c[1] - c[0], c[2] - c[1]), newell_normal(c)), 0.0);
  }
}

TEST(Gears, TeethMeshWithTheNeighborsTeeth) {
  const Scene scene = load_scene("gears:n=2");
  const double radius = 1.0 / 1.95;
  const auto left = corners_of(scene, scene.polygons[1]);         // at x = 0, y = 0
  const auto right = corners_of(scene, scene.polygons[1 + 146]);  // at x = 1, y = 0
  const glm::dvec2 left_center(radius - 1.0, radius - 1.0);
  const glm::dvec2 right_center = left_center + glm::dvec2(1.9 * radius, 0.0);
  double nearest = 1.0;
  for (std::size_t i = 0; i < 144; ++i) {
    const double own = i % 4 < 2 ? 0.995 : 0.9;
    EXPECT_NEAR(glm::distance(glm::dvec2(left[i]), left_center), own * radius, 1e-7);
    EXPECT_NEAR(glm::distance(glm::dvec2(right[i]), right_center), own * radius, 1e-7);
    nearest = std::min(nearest, glm::distance(glm::dvec2(right[i]), left_center));
  }
  EXPECT_GT(nearest, 0.9 * radius) << "a tip touches the gap between two teeth";
  EXPECT_LT(nearest, 0.93 * radius) << "the gears do not mesh";
  // Half a tooth apart: a tooth points along +x on the left, a gap along -x on the right.
  EXPECT_NEAR(left[0].y + left[1].y, 2.0 * left_center.y, 1e-6);
  EXPECT_NEAR(right[4 * 17 + 2].y + right[4 * 17 + 3].y, 2.0 * left_center.y, 1e-6);
}

TEST(Mount, GlassSpheresTouchOneAnother) {
  const Scene scene = load_scene("mount:n=2");
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_NEAR(glm::distance(scene.spheres[i].center, scene.spheres[k].center), 0.34, 1e-6);
    }
  }
}

TEST(Mount, CornersStayAtHeightZeroAndTheEdgesAreShared) {
  const Scene scene = load_scene("mount:n=5");
  EXPECT_EQ(scene.vertices.size(), 33U * 33U);
  for (const std::size_t corner : {0U, 32U, 32U * 33U, 33U * 33U - 1U}) {
    EXPECT_EQ(std::abs(scene.vertices[corner].x), 1.0F);
    EXPECT_EQ(std::abs(scene.vertices[corner].y), 1.0F);
    EXPECT_EQ(scene.vertices[corner].z, 0.0F);
  }
}

TEST(Rings, PentagonsAreRegularAndFillAUnitSphere) {
  const Scene scene = load_scene("rings:n=1");
  const double circle = 1.0 / 1.07412;
  const double side = 2.0 * circle * std::sin(std::acos(-1.0) / 5.0);
  const glm::dvec3 center(0.0, 1.0 / std::sin(std::acos(-1.0) / 8.0), 0.0);
  for (const Cone& cone : scene.cones) {
    EXPECT_NEAR(glm::distance(cone.base, cone.apex), side, 1e-6);
    EXPECT_EQ(cone.base_radius, 0.07412F);
  }
  double nearest = 10.0;
  for (std::size_t i = 0; i < 30; ++i) {
    const glm::dvec3 p(scene.spheres[i].center);
    EXPECT_NEAR(glm::distance(p, center), circle, 1e-6);
    for (std::size_t k = 0; k < i; ++k) {
      nearest = std::min(nearest, glm::distance(p, glm::dvec3(scene.spheres[k].center)));
    }
  }
  // Neighboring edge midpoints of a dodecahedron subtend 36 degrees.
  EXPECT_NEAR(nearest, 2.0 * circle * std::sin(std::acos(-1.0) / 10.0), 1e-6);
}

TEST(Tree, BranchesGrowFromTheirParentsEnds) {
  const Scene scene = load_scene("tree:n=3");
  const auto less = [](const glm::vec3& a, const glm::vec3& b) {
    return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
  };
  std::map<glm::vec3, int, decltype(less)> children(less);
  for (const Cone& cone : scene.cones) {
    ++children[cone.base];
    const double taper = double{cone.apex_radius} / double{cone.base_radius};
    EXPECT_NEAR(taper, 0.67, 1e-6);
  }
  EXPECT_EQ(children.at({0, 0, 0}), 1);
  int ends = 0;
  for (std::size_t i = 0; i < scene.cones.size(); ++i) {
    EXPECT_EQ(scene.spheres[i].center, scene.cones[i].apex);
    EXPECT_EQ(scene.spheres[i].radius, scene.cones[i].apex_radius);
    const auto found = children.find(scene.cones[i].apex);
    if (found == children.end()) {
      ++ends;
    } else {
      EXPECT_EQ(found->second, 2);
    }
  }
  EXPECT_EQ(ends, 8);
  // The first branch out of the trunk: 40 degrees from z, 0.65 long.
  const glm::dvec3 first = glm::dvec3(scene.cones[1].apex) - glm::dvec3(scene.cones[1].base);
  EXPECT_NEAR(glm::length(first), 0.65, 1e-6);
  EXPECT_NEAR(first.x, 0.65 * std::sin(40.0 * std::acos(-1.0) / 180.0), 1e-6);
  EXPECT_NEAR(first.z, 0.65 * std::cos(40.0 * std::acos(-1.0) / 180.0), 1e-6);
}

TEST(Lattice, CylindersEndInsideTheirSpheres) {
  const Scene scene = load_scene("lattice:n=2");
  for (const Cone& cone : scene.cones) {
    const double inset = std::hypot(0.5 * glm::distance(cone.base, cone.apex), cone.base_radius);
    EXPECT_GT(inset, 0.25 - 0.125) << "the ends are not in the middle of the cell";
    EXPECT_EQ(cone.base_radius, 1.0F / 32.0F);
    const bool hidden =
        std::any_of(scene.spheres.begin(), scene.spheres.end(), [&](const Sphere& sphere) {
          return std::hypot(glm::distance(sphere.center, cone.base), cone.base_radius) <
                 sphere.radius;
        });
    EXPECT_TRUE(hidden);
  }
}

TEST(Jacks, ChildrenAreHalfAsLargeInTheOctants) {
  const Scene scene = load_scene("jacks:n=2");
  const Cone& parent = scene.cones[0];
  const double length = glm::distance(parent.base, parent.apex);
  EXPECT_NEAR(length, 1.5, 1e-6);
  for (std::size_t jack = 1; jack < 9; ++jack) {
    const Cone& arm = scene.cones[3 * jack];
    EXPECT_NEAR(glm::distance(arm.base, arm.apex), 0.5 * length, 1e-6);
    const glm::dvec3 middle = 0.5 * (glm::dvec3(arm.base) + glm::dvec3(arm.apex));
    EXPECT_NEAR(glm::length(middle), std::sqrt(0.75), 1e-6);
  }
}

TEST(Sombrero, IsASquareWithItsPeakNearTheMiddle) {
  const Scene scene = load_scene("sombrero:n=2");
  EXPECT_EQ(scene.bounds.lower.x, -4.0F);
  EXPECT_EQ(scene.bounds.upper.z, 4.0F);
  EXPECT_EQ(scene.bounds.upper.y, -2.0F) << "1 above the floor at -3";
  for (const Polygon& polygon : scene.polygons) {
    EXPECT_GT(newell_normal(corners_of(scene, polygon)).y, 0.0);
  }
}

/// Returns a primitive represented by its positions alone, regardless of the order of its corners
/// or ends.
std::vector<std::array<float, 3>> places(const Scene& scene, PrimitiveId id) {
  const Primitive& primitive = scene.primitives[id];
  std::vector<std::array<float, 3>> all;
  const auto add = [&](const glm::vec3& p) { all.push_back({p.x, p.y, p.z}); };
  if (primitive.kind == PrimitiveKind::kSphere) {
    const Sphere& sphere = scene.spheres[primitive.index];
    add(sphere.center);
    all.push_back({sphere.radius, 0.0F, 0.0F});
    return all;
  }
  if (primitive.kind == PrimitiveKind::kCone) {
    const Cone& cone = scene.cones[primitive.index];
    const bool turn = std::array{cone.apex.x, cone.apex.y, cone.apex.z} <
                      std::array{cone.base.x, cone.base.y, cone.base.z};
    add(turn ? cone.apex : cone.base);
    add(turn ? cone.base : cone.apex);
    all.push_back({turn ? cone.apex_radius : cone.base_radius,
                   turn ? cone.base_radius : cone.apex_radius, 0.0F});
    return all;
  }
  for (const glm::dvec3& corner : corners_of(scene, scene.polygons[primitive.index])) add(corner);
  std::sort(all.begin(), all.end());
  return all;
}

/// Returns the specs of all scenes, with a small size if the scene has a size parameter.
std::vector<std::string> small_specs() {
  std::vector<std::string> specs;
  for (const SceneInfo& info : scene_catalogue()) {
    const bool sized = !info.parameters.empty() && info.parameters[0].name == "n";
    if (!sized) {
      specs.push_back(info.name);
      continue;
    }
    const auto least = static_cast<int>(info.parameters[0].minimum);
    for (int n = std::max(least, 1); n <= 3; ++n)
      specs.push_back(info.name + ":n=" + std::to_string(n));
  }
  return specs;
}

TEST(Catalogue, NoTwoPrimitivesAreTheSame) {
  for (const std::string& spec : small_specs()) {
    const Scene scene = load_scene(spec);
    std::vector<std::vector<std::array<float, 3>>> all;
    for (PrimitiveId id = 0; id < scene.primitives.size(); ++id) all.push_back(places(scene, id));
    std::sort(all.begin(), all.end());
    EXPECT_EQ(std::adjacent_find(all.begin(), all.end()), all.end()) << spec;
  }
}

TEST(Catalogue, EveryPolygonHasArea) {
  for (const std::string& spec : small_specs()) {
    const Scene scene = load_scene(spec);
    for (const Triangle& triangle : scene.triangles) {
      const glm::dvec3 a(scene.vertices[triangle.vertex[0]]);
      const glm::dvec3 b(scene.vertices[triangle.vertex[1]]);
      const glm::dvec3 c(scene.vertices[triangle.vertex[2]]);
      ASSERT_GT(glm::length(glm::cross(b - a, c - a)), 0.0) << spec << ", " << triangle.primitive;
    }
  }
}

}  // namespace
}  // namespace beambench::scenes
