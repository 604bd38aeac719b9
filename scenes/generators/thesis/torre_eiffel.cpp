#include <array>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scenes/base/portable_math.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/modelling/add_mesh.hpp"
#include "scenes/modelling/box.hpp"
#include "scenes/modelling/lathe.hpp"
#include "scenes/modelling/polygon_mesh.hpp"
#include "scenes/modelling/subdivide.hpp"
#include "scenes/modelling/sweep.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr double kFirstFloor = 57.0;
constexpr double kSecondFloor = 115.0;
constexpr double kThirdFloor = 276.0;
constexpr double kFloorDepth = 4.5;
constexpr double kClear = 0.5;  // distance from a floor to the nearest crossbar's axis

/// The distances of a leg's outer and inner posts from the center, on both axes.
struct Section {
  double height, outer, inner;
};

Section mixed(const Section& a, const Section& b, double share) {
  return {std::lerp(a.height, b.height, share), std::lerp(a.outer, b.outer, share),
          std::lerp(a.inner, b.inner, share)};
}

std::vector<Section> panels(const Section& from, const Section& to, int count) {
  std::vector<Section> sections;
  for (int i = 0; i <= count; ++i) {
    sections.push_back(mixed(from, to, static_cast<double>(i) / count));
  }
  return sections;
}

/// Returns the shaft's sections. The shaft narrows along its own curve, and its panels become
/// lower.
std::vector<Section> shaft_sections() {
  constexpr int kPanels = 28;
  constexpr double kFoot = kSecondFloor + kClear;
  constexpr double kHead = kThirdFloor - kFloorDepth - kClear;
  std::vector<Section> sections;
  for (int i = 0; i <= kPanels; ++i) {
    const double s = static_cast<double>(i) / kPanels;
    const double rise = s * (1.35 - 0.35 * s);
    const double rest = 1.0 - rise;
    sections.push_back({std::lerp(kFoot, kHead, rise), 5.2 + 11.8 * rest * (0.35 + 0.65 * rest),
                        1.6 + 5.4 * rest * rest});
  }
  return sections;
}

using Posts = std::vector<glm::dvec3>;

/// Returns a post through the sections; `x` and `y` map a section to a position on the axis.
template <typename X, typename Y>
Posts post(const std::vector<Section>& sections, X x, Y y) {
  Posts places;
  for (const Section& section : sections)
    places.emplace_back(x(section), y(section), section.height);
  return places;
}

double outer(const Section& section) { return section.outer; }
double inner(const Section& section) { return section.inner; }
double minus_outer(const Section& section) { return -section.outer; }
double minus_inner(const Section& section) { return -section.inner; }

/// Returns a post along the places that is a meter longer at each end, to reach into floors and
/// foundations.
modelling::PolygonMesh beam(Posts places, double thickness) {
  const std::size_t last = places.size() - 1;
  places[0] += glm::normalize(places[0] - places[1]);
  places[last] += glm::normalize(places[last] - places[last - 1]);
  const std::array<glm::dvec2, 4> square = {{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}};
  const std::vector<double> scales(places.size(), thickness);
  return modelling::sweep(square, places, scales, {1.0, 0.0, 0.0}, modelling::Caps::kNone);
}

/// Returns four copies of a mesh, in the corners or on the sides of the tower.
modelling::PolygonMesh four_times(const modelling::PolygonMesh& one) {
  modelling::PolygonMesh mesh;
  for (int i = 0; i < 4; ++i)
    modelling::append(mesh, modelling::transformed(one, modelling::rotation(2, 90.0 * i)));
  return mesh;
}

Posts halfway(const Posts& a, const Posts& b) {
  Posts places;
  for (std::size_t i = 0; i < a.size(); ++i) places.push_back(0.5 * (a[i] + b[i]));
  return places;
}

/// Returns one side of a leg: a thin post in its middle, with bracing on both sides.
modelling::PolygonMesh leg_side(const Posts& left, const Posts& right, const glm::dvec3& outward,
                                const modelling::Bracing& bracing) {
  const Posts center = halfway(left, right);
  modelling::PolygonMesh mesh = beam(center, 1.2 * bracing.crossbar);
  modelling::append(mesh, modelling::braced_face(left, center, outward, bracing));
  modelling::append(mesh, modelling::braced_face(center, right, outward, bracing));
  return mesh;
}

/// Returns the leg in the corner x > 0, y > 0.
modelling::PolygonMesh leg(const std::vector<Section>& sections, double thickness,
                           const modelling::Bracing& bracing) {
  const std::array<Posts, 4> posts = {post(sections, outer, outer), post(sections, inner, outer),
                                      post(sections, inner, inner), post(sections, outer, inner)};
  const std::array<glm::dvec3, 4> outward = {
      {{0.0, 1.0, 0.0}, {-1.0, 0.0, 0.0}, {0.0, -1.0, 0.0}, {1.0, 0.0, 0.0}}};
  modelling::PolygonMesh mesh;
  for (std::size_t i = 0; i < 4; ++i) {
    modelling::append(mesh, beam(posts[i], thickness));
    modelling::append(mesh, leg_side(posts[i], posts[(i + 1) % 4], outward[i], bracing));
  }
  return mesh;
}

/// Returns the shaft's side y < 0 with its left corner post, and with bracing between the outer and
/// the inner posts.
modelling::PolygonMesh shaft_side() {
  const std::vector<Section> sections = shaft_sections();
  const glm::dvec3 outward(0.0, -1.0, 0.0);
  const std::array<Posts, 4> posts = {
      post(sections, minus_outer, minus_outer), post(sections, minus_inner, minus_outer),
      post(sections, inner, minus_outer), post(sections, outer, minus_outer)};
  modelling::PolygonMesh mesh = beam(posts[0], 0.95);
  modelling::append(mesh, beam(posts[1], 0.55));
  modelling::append(mesh, beam(posts[2], 0.55));
  const modelling::Bracing bracing = {0.38, 0.32};
  modelling::append(mesh, modelling::braced_face(posts[0], posts[1], outward, bracing));
  modelling::append(mesh, modelling::braced_face(posts[2], posts[3], outward, bracing));
  for (std::size_t i = 0; i < sections.size(); i += 2) {
    modelling::append(mesh, modelling::bar(posts[1][i], posts[2][i], outward, bracing.crossbar));
  }
  return mesh;
}

/// Returns the round arch between the feet on the side y < 0, leaning as the legs do.
modelling::PolygonMesh arch() {
  constexpr int kSteps = 30;
  constexpr double kRadius = 37.0;
  constexpr double kDepth = 3.6;
  Posts low;
  Posts high;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = std::numbers::pi * (0.04 + 0.92 * i / kSteps);
    const glm::dvec2 direction(-portable_cos(angle), portable_sin(angle));
    const glm::dvec2 start(0.0, 10.0);
    const glm::dvec2 inside = start + kRadius * direction;
    const glm::dvec2 beyond = start + (kRadius + kDepth) * direction;
    const auto lean = [](double height) { return -62.5 + 29.5 * height / kFirstFloor; };
    low.emplace_back(inside.x, lean(inside.y), inside.y);
    high.emplace_back(beyond.x, lean(beyond.y), beyond.y);
  }
  const glm::dvec3 outward = glm::normalize(glm::dvec3(0.0, -kFirstFloor, 29.5));
  modelling::PolygonMesh mesh = beam(low, 0.9);
  modelling::append(mesh, beam(high, 0.7));
  modelling::append(mesh, modelling::braced_face(low, high, outward, {0.4, 0.35}));
  return mesh;
}

/// Returns the posts and two rails of a gallery on the side y < 0 of a floor.
modelling::PolygonMesh gallery_side(double height, double half, int posts, double rise) {
  const glm::dvec3 outward(0.0, -1.0, 0.0);
  modelling::PolygonMesh mesh;
  const glm::dvec3 left(-half, -half, height);
  const glm::dvec3 right(half, -half, height);
  const glm::dvec3 up(0.0, 0.0, rise);
  modelling::append(mesh, modelling::bar(left + up, right + up, outward, 0.5));
  modelling::append(mesh, modelling::bar(left + 0.5 * up, right + 0.5 * up, outward, 0.3));
  for (int i = 0; i < posts; ++i) {
    const glm::dvec3 foot = glm::mix(left, right, static_cast<double>(i) / posts);
    modelling::append(mesh, modelling::bar(foot, foot + up, outward, 0.4));
  }
  return mesh;
}

/// Returns the four legs from the ground to the second floor, the shaft above and the arches
/// between the legs, in meters, with the center of the base at the origin.
modelling::PolygonMesh iron_tower() {
  const Section ground = {3.2 + kClear, 60.8, 36.3};
  const Section below_first = {kFirstFloor - kFloorDepth - kClear, 35.2, 18.2};
  const Section above_first = {kFirstFloor + kClear, 32.5, 16.5};
  const Section below_second = {kSecondFloor - kFloorDepth - kClear, 19.0, 8.2};
  modelling::PolygonMesh mesh = four_times(leg(panels(ground, below_first, 7), 1.7, {0.75, 0.6}));
  modelling::append(mesh, four_times(leg(panels(above_first, below_second, 8), 1.2, {0.55, 0.45})));
  modelling::append(mesh, four_times(shaft_side()));
  modelling::append(mesh, four_times(arch()));
  return mesh;
}

/// Returns the three floors, without their galleries.
modelling::PolygonMesh tower_floors() {
  modelling::PolygonMesh mesh =
      modelling::square_ring(38.0, 13.0, kFirstFloor - kFloorDepth, kFirstFloor);
  modelling::append(mesh,
                    modelling::square_ring(21.5, 5.0, kSecondFloor - kFloorDepth, kSecondFloor));
  modelling::append(mesh, modelling::beveled_box({-8.2, -8.2, kThirdFloor - kFloorDepth},
                                                 {8.2, 8.2, kThirdFloor}, 0.8));
  return mesh;
}

/// Returns the galleries around the floors: posts and rails.
modelling::PolygonMesh tower_galleries() {
  modelling::PolygonMesh side = gallery_side(kFirstFloor, 37.4, 36, 3.2);
  modelling::append(side, gallery_side(kSecondFloor, 21.0, 22, 2.8));
  modelling::append(side, gallery_side(kThirdFloor, 7.2, 9, 2.6));
  return four_times(side);
}

/// Returns the lantern above the third floor and its mast, which reaches 324 meters.
modelling::PolygonMesh tower_top() {
  const std::vector<glm::dvec2> lantern = {{4.6, 276.0}, {4.6, 282.0}, {5.6, 282.6}, {5.6, 284.0},
                                           {3.4, 285.0}, {3.4, 291.0}, {3.9, 291.4}, {3.6, 293.2},
                                           {2.7, 295.0}, {1.4, 296.2}, {1.0, 296.6}, {1.0, 304.0},
                                           {0.6, 304.6}, {0.6, 314.0}, {0.3, 314.5}, {0.0, 324.0}};
  return modelling::lathe(lantern, 16);
}

/// Returns the stone blocks under the posts of the legs.
modelling::PolygonMesh tower_foundations() {
  modelling::PolygonMesh block;
  for (const double x : {36.6, 61.2}) {
    for (const double y : {36.6, 61.2}) {
      modelling::append(
          block, modelling::beveled_box({x - 4.0, y - 4.0, 0.0}, {x + 4.0, y + 4.0, 3.2}, 0.7));
    }
  }
  return four_times(block);
}

constexpr std::size_t kPolygons = 16648;

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  builder.add_camera({.from = {190.0F, -440.0F, 40.0F},
                      .at = {0.0F, 0.0F, 158.0F},
                      .up = {0.0F, 0.0F, 1.0F},
                      .angle = 42.0F});
  builder.set_background({0.56, 0.76, 0.95});
  builder.add_light({500.0, -700.0, 600.0}, glm::dvec3(0.85));
  builder.add_light({-600.0, -300.0, 200.0}, glm::dvec3(0.4));

  builder.set_surface({.color = {0.50F, 0.36F, 0.24F}, .diffuse = 0.9F});
  modelling::add_flat(builder, iron_tower());
  modelling::add_flat(builder, tower_galleries());
  modelling::add_smooth(builder, tower_top());
  builder.set_surface({.color = {0.78F, 0.74F, 0.66F}, .diffuse = 0.9F});
  modelling::add_flat(builder, tower_foundations());
  builder.set_surface({.color = {0.60F, 0.45F, 0.31F}, .diffuse = 0.9F});
  modelling::add_flat(
      builder, modelling::subdivided_to(tower_floors(), kPolygons - builder.primitive_count()));
  return std::move(builder).build();
}

}  // namespace

void register_torre_eiffel(Catalogue& catalogue) {
  catalogue.add(
      {"torre-eiffel",
       "The thesis's Torre Eiffel: a lattice tower of 16,648 polygons with empty space around it",
       {},
       generate});
}

}  // namespace beambench::scenes::generators
