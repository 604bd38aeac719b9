#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <tuple>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "scenes/catalogue.hpp"
#include "tests/scenes/thrown_message.hpp"

namespace beambench::scenes {
namespace {

struct Expected {
  const char* spec;
  std::size_t spheres;
  std::size_t polygons;
};

void PrintTo(const Expected& expected, std::ostream* stream) { *stream << expected.spec; }

class Counts : public testing::TestWithParam<Expected> {};

TEST_P(Counts, MatchTheDefinitions) {
  const Scene scene = load_scene(GetParam().spec);
  EXPECT_EQ(scene.spheres.size(), GetParam().spheres);
  EXPECT_EQ(scene.polygons.size(), GetParam().polygons);
  EXPECT_EQ(scene.primitives.size(), GetParam().spheres + GetParam().polygons);
}

INSTANTIATE_TEST_SUITE_P(
    Catalogue, Counts,
    testing::Values(
        Expected{"balls:n=0", 1, 1}, Expected{"balls:n=2", 91, 1}, Expected{"balls", 7381, 1},
        Expected{"tetra:n=1", 0, 4}, Expected{"tetra:n=3", 0, 64}, Expected{"tetra", 0, 4096},
        Expected{"stetra", 0, 256}, Expected{"escena1", 430, 0},
        Expected{"escena1:spheres=1", 1, 0}, Expected{"escena2", 91, 1},
        Expected{"finishes", 12, 120}, Expected{"bumpy", 0, 15552},
        Expected{"bumpy:triangles=12", 0, 12}, Expected{"bumpy:triangles=200000", 0, 199692},
        Expected{"closed-room", 0, 32272}, Expected{"closed-room:detail=1", 0, 576},
        Expected{"closed-room:detail=9", 0, 40928}, Expected{"aquarium", 0, 22600},
        Expected{"aquarium:detail=1", 0, 2860}, Expected{"aquarium:detail=5", 0, 10924},
        Expected{"prism", 0, 26807}, Expected{"prism:detail=1", 0, 1019},
        Expected{"prism:detail=5", 0, 11723}, Expected{"soup", 0, 20000},
        Expected{"exploding-mesh", 0, 23936}, Expected{"falling-spheres", 430, 1},
        Expected{"turning-solids", 0, 14941}, Expected{"twisting-body", 0, 20593},
        Expected{"waving-sheet", 0, 20000}, Expected{"waving-sheet:triangles=1000000", 0, 999698},
        Expected{"falling-spheres:spheres=7", 7, 1}, Expected{"soup:triangles=1", 0, 1},
        Expected{"tessellated-balls", 0, 96320},
        Expected{"tessellated-balls:slices=6,spheres=5", 0, 5 * 24}),
    [](const auto& info) {
      std::string name = info.param.spec;
      std::replace_if(
          name.begin(), name.end(), [](char c) { return std::isalnum(c) == 0; }, '_');
      return name;
    });

TEST(Catalogue, SceneHashesArePinned) {
  const std::map<std::string, std::uint64_t> hashes = {
      {"ajedrez", 0x141e951750a1546e},
      {"aquarium", 0x1b17ff70f13f02fb},
      {"balls", 0x4ec0de13a661c1e3},
      {"bola-espacial", 0xde697676114a3c08},
      {"bumpy", 0xdb2bb96ee4060375},
      {"caracol", 0xece2bddf3ffb36c7},
      {"casa-de-campo", 0x9ddb86ac08fd857f},
      {"closed-room", 0x46ba5d68b70ed5cf},
      {"delfines", 0x09365fe510804189},
      {"escena1", 0xd11e781ffd1bb313},
      {"escena2", 0x9d87ad15fbf7a3c4},
      {"exploding-mesh", 0x49675dd967b4cb8b},
      {"falling-spheres", 0xb13f58e14d2299e4},
      {"finishes", 0xfcf5f1ce62d7f07d},
      {"flamenco", 0x18caa2d84303aed3},
      {"gato-bill", 0x5f6e6f201f6d4cab},
      {"gears", 0x2788c3eafe0614b7},
      {"habitacion", 0x833d7e989334271b},
      {"jacks", 0xcb34972e4e1c3ffd},
      {"lattice", 0x3251fd8ab231338c},
      {"maceta", 0x2ac9d3cc17a6712c},
      {"misil", 0x032cb75abdd2f8ea},
      {"mount", 0x161ae288891688a3},
      {"prism", 0xd8a24188c5fd1687},
      {"rings", 0x0f27dc72e21f1bb8},
      {"shells", 0x091e2056d8ef061a},
      {"sombrero", 0xc6d55dae08c426c5},
      {"soup", 0x28e0e97b897bda33},
      {"stetra", 0xb7c5999641909e78},
      {"teapot", 0x7ee8e74a7f20ad0f},
      {"tessellated-balls", 0x102d62341341ae7e},
      {"tetera", 0x4d415d421365ff93},
      {"tetra", 0x38c3e535c1bd53f0},
      {"torre-eiffel", 0xa44a81f18aa61d8a},
      {"tree", 0xcf6d525f70c012df},
      {"turning-solids", 0x9f7bb3254e6c5eef},
      {"twisting-body", 0xda5aa4be6ed7bcd8},
      {"waving-sheet", 0xf1a56eff59bb9bc2},
  };
  for (const SceneInfo& info : scene_catalogue()) {
    ASSERT_TRUE(hashes.contains(info.name)) << "pin the hash of " << info.name;
    EXPECT_EQ(scene_hash(load_scene(info.name)), hashes.at(info.name))
        << info.name << " has changed: published results are no longer comparable";
  }
}

TEST(Catalogue, IsSortedAndDescribed) {
  const auto catalogue = scene_catalogue();
  EXPECT_TRUE(std::is_sorted(catalogue.begin(), catalogue.end(),
                             [](const auto& a, const auto& b) { return a.name < b.name; }));
  for (const SceneInfo& info : catalogue) EXPECT_FALSE(info.summary.empty()) << info.name;
}

TEST(Catalogue, ScenesAreNamedByTheirLabel) {
  EXPECT_EQ(load_scene("balls").name, "balls:n=4");
  EXPECT_EQ(load_scene("tetra:n=02").name, "tetra:n=2");
  EXPECT_EQ(load_scene("stetra").name, "stetra");
}

TEST(Catalogue, TheRequestedResolutionOfASceneHasSquarePixels) {
  for (const SceneInfo& info : scene_catalogue()) {
    for (const Camera& camera : load_scene(info.name).cameras) {
      EXPECT_FLOAT_EQ(static_cast<float>(camera.width) / static_cast<float>(camera.height),
                      camera.aspect)
          << info.name << ", camera " << camera.name;
    }
  }
}

TEST(Catalogue, WrongRequestsNameTheRemedy) {
  EXPECT_TRUE(says(thrown_message([] { load_scene("bals:n=3"); }),
                   {"'bals'", "did you mean 'balls'", "tetra"}));
  EXPECT_TRUE(says(thrown_message([] { load_scene("balls:n=9"); }), {"from 0 to 8"}));
  EXPECT_TRUE(
      says(thrown_message([] { load_scene("balls:depth=2"); }), {"'depth'", "valid ones are n"}));
  EXPECT_TRUE(
      says(thrown_message([] { load_scene("no/such/file"); }), {"no/such/file", "cannot be read"}));
  EXPECT_TRUE(says(thrown_message([] { load_scene("missing.nff"); }), {"missing.nff"}));
  EXPECT_TRUE(says(thrown_message([] { load_scene(""); }), {"name is missing"}));
}

TEST(Catalogue, StetraIsTetraOfFourLevels) {
  EXPECT_EQ(scene_hash(load_scene("stetra")), scene_hash(load_scene("tetra:n=4")));
}

/// Returns whether the point is in the camera's frustum.
bool sees(const Camera& camera, const glm::dvec3& point) {
  const glm::dvec3 forward = glm::normalize(glm::dvec3(camera.at) - glm::dvec3(camera.from));
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(camera.up)));
  const glm::dvec3 up = glm::cross(right, forward);
  const glm::dvec3 to = point - glm::dvec3(camera.from);
  const double half = std::tan(glm::radians(0.5 * static_cast<double>(camera.angle)));
  const double depth = glm::dot(to, forward);
  return depth > 0.0 && std::abs(glm::dot(to, right)) <= half * depth * camera.aspect &&
         std::abs(glm::dot(to, up)) <= half * depth;
}

TEST(Catalogue, CamerasSeeTheirScenes) {
  for (const char* spec :
       {"escena1", "escena2", "bumpy", "tetra", "tessellated-balls:slices=4", "soup"}) {
    const Scene scene = load_scene(spec);
    for (const Sphere& sphere : scene.spheres) {
      EXPECT_TRUE(sees(scene.cameras[0], sphere.center)) << spec;
    }
    for (const glm::vec3& vertex : scene.vertices) {
      EXPECT_TRUE(sees(scene.cameras[0], vertex)) << spec;
    }
  }
}

using Corner = std::array<double, 3>;

/// Returns the points c +- w with signs whose product is +1: a tetrahedron of half-size w.
std::set<Corner> tetrahedron(const Corner& c, double w) {
  std::set<Corner> corners;
  for (const double x : {-w, w}) {
    for (const double y : {-w, w}) corners.insert({c[0] + x, c[1] + y, c[2] + x * y / w});
  }
  return corners;
}

TEST(Tetra, CoordinatesFollowTheDefinition) {
  for (const int n : {1, 2}) {
    const Scene scene = load_scene("tetra:n=" + std::to_string(n));
    std::multiset<std::set<Corner>> expected;  // the four corners of each leaf
    if (n == 1) {
      expected.insert(tetrahedron({0, 0, 0}, 1.0));
    } else {
      for (const Corner& center : tetrahedron({0, 0, 0}, 0.5)) {
        expected.insert(tetrahedron(center, 0.5));
      }
    }
    std::multiset<std::set<Corner>> found;
    for (std::size_t leaf = 0; leaf < scene.triangles.size(); leaf += 4) {
      std::set<Corner> corners;
      for (std::size_t face = leaf; face < leaf + 4; ++face) {
        for (const std::uint32_t vertex : scene.triangles[face].vertex) {
          const glm::vec3 p = scene.vertices[vertex];
          corners.insert({p.x, p.y, p.z});
        }
      }
      found.insert(corners);
    }
    EXPECT_EQ(found, expected) << n;
  }
}

TEST(Tetra, FacesLookOutward) {
  const Scene scene = load_scene("tetra:n=1");
  for (const Triangle& triangle : scene.triangles) {
    const glm::vec3 a = scene.vertices[triangle.vertex[0]];
    const glm::vec3 b = scene.vertices[triangle.vertex[1]];
    const glm::vec3 c = scene.vertices[triangle.vertex[2]];
    EXPECT_GT(glm::dot(glm::cross(b - a, c - a), a + b + c), 0.0F);
  }
}

/// Calls check(parent, child, number of the child) for every parent and child in a sphereflake of
/// `depth` levels, which lists parents first.
template <typename Check>
void for_each_child(const std::vector<Sphere>& spheres, std::size_t& next, int depth, Check check) {
  const std::size_t parent = next++;
  for (int child = 0; depth > 0 && child < 9; ++child) {
    check(spheres[parent], spheres[next], child);
    for_each_child(spheres, next, depth - 1, check);
  }
}

TEST(Balls, ChildrenTouchTheirParentAndAreAThirdAsLarge) {
  const Scene scene = load_scene("balls:n=4");
  std::size_t next = 0;
  for_each_child(scene.spheres, next, 4, [](const Sphere& parent, const Sphere& child, int) {
    const double distance = glm::length(glm::dvec3(child.center) - glm::dvec3(parent.center));
    EXPECT_NEAR(distance, static_cast<double>(parent.radius) + child.radius, 3e-7);
    EXPECT_NEAR(child.radius * 3.0, parent.radius, 1e-7);
  });
  EXPECT_EQ(next, scene.spheres.size());
}

TEST(Balls, FirstChildrenStandAtTheirAzimuthAndElevation) {
  const Scene scene = load_scene("balls:n=1");
  constexpr std::array<double, 9> kAzimuth = {15, 75, 135, 195, 255, 315, 45, 165, 285};
  for (std::size_t i = 0; i < 9; ++i) {
    const double elevation = glm::radians(i < 6 ? 0.0 : 54.7356);
    const double azimuth = glm::radians(kAzimuth[i]);
    const glm::dvec3 expected =
        2.0 / 3.0 *
        glm::dvec3(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                   std::sin(elevation));
    EXPECT_LT(glm::length(glm::dvec3(scene.spheres[i + 1].center) - expected), 1e-6) << i;
  }
}

TEST(Balls, GrandchildrenFollowTheSmallestRotationFromZ) {
  // The three upper children of a child lie above its equator, at an angle with sine sqrt(2/3).
  const Scene scene = load_scene("balls:n=2");
  std::size_t next = 0;
  glm::dvec3 axis(0.0, 0.0, 1.0);
  for_each_child(scene.spheres, next, 2, [&](const Sphere& parent, const Sphere& child, int i) {
    const glm::dvec3 out = glm::normalize(glm::dvec3(child.center) - glm::dvec3(parent.center));
    const glm::dvec3 own =
        parent.radius == 0.5F ? glm::dvec3(0, 0, 1) : glm::normalize(glm::dvec3(parent.center));
    EXPECT_NEAR(glm::dot(out, own), i < 6 ? 0.0 : std::sqrt(2.0 / 3.0), 1e-6);
    // The smallest rotation from z to `own` keeps the axis z x own in place.
    const glm::dvec3 fixed = glm::cross(glm::dvec3(0, 0, 1), own);
    if (glm::length(fixed) < 1e-9) return;
    const double azimuth = glm::radians(i < 6 ? 15.0 + 60.0 * i : 45.0 + 120.0 * (i - 6));
    const double level = i < 6 ? 1.0 : std::sqrt(1.0 / 3.0);
    const glm::dvec3 local(level * std::cos(azimuth), level * std::sin(azimuth), 0.0);
    EXPECT_NEAR(glm::dot(out, glm::normalize(fixed)), glm::dot(local, glm::normalize(fixed)), 1e-6);
  });
}

TEST(Escena1, FillsItsVolumeEvenlyWithDisjointSpheres) {
  const Scene scene = load_scene("escena1");
  std::map<std::tuple<bool, bool, bool>, int> in_octant;
  for (std::size_t i = 0; i < scene.spheres.size(); ++i) {
    const glm::dvec3 c(scene.spheres[i].center);
    ++in_octant[{c.x > 0, c.y > 0, c.z > 0}];
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_GT(glm::length(c - glm::dvec3(scene.spheres[k].center)),
                scene.spheres[i].radius + scene.spheres[k].radius - 1e-5);
    }
  }
  for (const auto& [octant, count] : in_octant) EXPECT_NEAR(count, 430 / 8, 20);
  EXPECT_EQ(in_octant.size(), 8U);
  const auto [least, largest] =
      std::minmax_element(scene.spheres.begin(), scene.spheres.end(),
                          [](const Sphere& a, const Sphere& b) { return a.radius < b.radius; });
  EXPECT_GT(largest->radius, 2.0F * least->radius);
}

// These hashes date from before the grid, when a plain search found the nearest ball.
TEST(Escena1, IsUnchangedByItsGrid) {
  EXPECT_EQ(scene_hash(load_scene("escena1:spheres=7")), 0x2a7353dd7127c1eaU);
  EXPECT_EQ(scene_hash(load_scene("escena1:spheres=2000")), 0xc0a046104b83e4feU);
}

TEST(Escena1, FollowsItsSeed) {
  EXPECT_EQ(scene_hash(load_scene("escena1:seed=5")), scene_hash(load_scene("escena1:seed=5")));
  EXPECT_NE(scene_hash(load_scene("escena1:seed=5")), scene_hash(load_scene("escena1:seed=6")));
}

TEST(Escena2, FlakeIsTinyInAHugeVolume) {
  const Scene scene = load_scene("escena2");
  Bounds flake;
  for (PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    if (scene.primitives[id].kind == PrimitiveKind::kSphere) {
      flake.include(primitive_bounds(scene, id));
    }
  }
  EXPECT_GT(scene.bounds.extent().x, 20.0F * flake.extent().x);
  EXPECT_GT(scene.bounds.extent().z, 20.0F * flake.extent().z);
  EXPECT_LT(flake.upper.y, scene.bounds.upper.y) << "the polygon stands behind";
}

/// Returns the number of edges of triangles over shared vertices that do not belong to exactly two
/// triangles, once in each direction.
std::size_t count_open_edges(std::span<const Triangle> triangles) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const Triangle& t : triangles) {
    for (std::size_t i = 0; i < 3; ++i) ++edges[{t.vertex[i], t.vertex[(i + 1) % 3]}];
  }
  return static_cast<std::size_t>(std::ranges::count_if(edges, [&](const auto& edge) {
    return edge.second != 1 || !edges.contains({edge.first.second, edge.first.first});
  }));
}

/// Expects every edge to belong to exactly two triangles, once in each direction: closed and
/// oriented.
void expect_closed(const Scene& scene) {
  RC_ASSERT(count_open_edges(scene.triangles) == 0);
  RC_ASSERT(scene.vertices.size() == scene.triangles.size() / 2 + 2);  // Euler
}

RC_GTEST_PROP(Bumpy, IsClosedAndShared, ()) {
  const int triangles = *rc::gen::inRange(12, 4000);
  expect_closed(load_scene("bumpy:triangles=" + std::to_string(triangles)));
}

TEST(ClosedRoom, HasNoGapInItsShell) {
  for (const int detail : {1, 3, 8}) {
    const Scene scene = load_scene("closed-room:detail=" + std::to_string(detail));
    const auto shell = static_cast<std::size_t>(44 * detail * detail);
    EXPECT_EQ(count_open_edges(std::span(scene.triangles).first(shell)), 0U);
    for (std::size_t i = 0; i < shell; ++i) {  // they face the middle of the room
      const glm::dvec3 a(scene.vertices[scene.triangles[i].vertex[0]]);
      const glm::dvec3 b(scene.vertices[scene.triangles[i].vertex[1]]);
      const glm::dvec3 c(scene.vertices[scene.triangles[i].vertex[2]]);
      ASSERT_GT(glm::dot(glm::cross(b - a, c - a), glm::dvec3(5.0, 4.0, 2.0) - a), 0.0);
    }
  }
}

TEST(TessellatedBalls, AreTheBallsOfEscena1AsClosedMeshes) {
  const Scene balls = load_scene("escena1:spheres=9");
  const Scene meshes = load_scene("tessellated-balls:spheres=9");
  constexpr std::size_t kTriangles = 224;  // of a ball
  EXPECT_EQ(count_open_edges(meshes.triangles), 0U);
  for (std::size_t i = 0; i < meshes.triangles.size(); ++i) {
    const Sphere& ball = balls.spheres[i / kTriangles];
    for (const std::uint32_t vertex : meshes.triangles[i].vertex) {
      const glm::dvec3 p(meshes.vertices[vertex]);
      ASSERT_NEAR(glm::length(p - glm::dvec3(ball.center)), ball.radius, 1e-5);
    }
  }
}

TEST(Soup, SharesNothingAndKeepsItsDensity) {
  for (const auto& [count, reach] : {std::pair(1000, 0.06), std::pair(8000, 0.03)}) {
    const Scene scene = load_scene("soup:triangles=" + std::to_string(count));
    EXPECT_EQ(scene.vertices.size(), 3U * static_cast<std::size_t>(count));
    for (const Triangle& triangle : scene.triangles) {
      const glm::vec3 a = scene.vertices[triangle.vertex[0]];
      for (const std::uint32_t other : triangle.vertex) {
        const glm::vec3 away = glm::abs(scene.vertices[other] - a);
        ASSERT_LE(std::max({away.x, away.y, away.z}), 2.001 * reach);
      }
    }
  }
}

TEST(Bumpy, IsStarShapedAndLooksOutward) {
  const Scene scene = load_scene("bumpy");
  for (const Triangle& t : scene.triangles) {
    const glm::dvec3 a(scene.vertices[t.vertex[0]]);
    const glm::dvec3 b(scene.vertices[t.vertex[1]]);
    const glm::dvec3 c(scene.vertices[t.vertex[2]]);
    EXPECT_GT(glm::dot(a, glm::cross(b, c)), 0.0);
  }
}

TEST(Bumpy, ComesAsCloseAsPossibleToTheRequestedNumber) {
  for (const int wanted : {12, 29, 31, 5000, 15680, 100000}) {
    const auto got = static_cast<double>(
        load_scene("bumpy:triangles=" + std::to_string(wanted)).triangles.size());
    const double k = std::sqrt(got / 12.0);
    EXPECT_EQ(k, std::floor(k));
    EXPECT_LE(std::abs(got - wanted), std::abs(12.0 * (k + 1) * (k + 1) - wanted));
    const double smaller = std::max(12.0, 12.0 * (k - 1) * (k - 1));
    EXPECT_LE(std::abs(got - wanted), std::abs(smaller - wanted));
  }
}

}  // namespace
}  // namespace beambench::scenes
