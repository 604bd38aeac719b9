#include <array>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "scenes/base/portable_math.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/modelling/add_mesh.hpp"
#include "scenes/modelling/polygon_mesh.hpp"
#include "scenes/modelling/subdivide.hpp"

namespace beambench::scenes::generators {
namespace {

/// A dolphin's pose; radians over its length of 1.
struct DolphinPose {
  double arch = 0.0;  ///< bends the back, with head and tail down
  double turn = 0.0;  ///< bends head and tail to the dolphin's left
};

/// A bottlenose dolphin of `triangles` triangles: body, dorsal fin, two flippers, two flukes.
/// Before it bends, it is 1 long from beak (x = 0.5) to fluke (x = -0.5), with its back toward +z.
/// `belly` marks the pale triangles.
struct Dolphin {
  modelling::PolygonMesh mesh;
  std::vector<bool> belly;
};

/// A cross-section of the body, `at` of the way from the beak to the fluke.
struct Section {
  double at, half_height, half_width, lift;
};
constexpr std::array<Section, 16> kBody = {{{0.000, 0.000, 0.000, -0.018},
                                            {0.012, 0.013, 0.015, -0.018},
                                            {0.072, 0.019, 0.021, -0.016},
                                            {0.102, 0.042, 0.038, 0.000},
                                            {0.140, 0.060, 0.054, 0.004},
                                            {0.200, 0.077, 0.071, 0.004},
                                            {0.280, 0.091, 0.085, 0.001},
                                            {0.370, 0.099, 0.093, 0.000},
                                            {0.460, 0.098, 0.091, 0.000},
                                            {0.550, 0.089, 0.080, 0.002},
                                            {0.640, 0.075, 0.064, 0.004},
                                            {0.730, 0.058, 0.046, 0.006},
                                            {0.810, 0.043, 0.030, 0.007},
                                            {0.880, 0.030, 0.018, 0.006},
                                            {0.940, 0.018, 0.011, 0.004},
                                            {0.985, 0.000, 0.000, 0.003}}};
constexpr int kSides = 12;

modelling::PolygonMesh body() {
  modelling::PolygonMesh mesh;
  for (const Section& section : kBody) {
    for (int i = 0; i < kSides; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kSides;
      mesh.vertices.emplace_back(0.5 - section.at, -section.half_width * portable_cos(angle),
                                 section.lift + section.half_height * portable_sin(angle));
    }
  }
  for (std::uint32_t k = 0; k + 1 < kBody.size(); ++k) {
    for (std::uint32_t i = 0; i < kSides; ++i) {
      const std::uint32_t next = (i + 1) % kSides;
      mesh.polygons.push_back(
          {k * kSides + next, (k + 1) * kSides + next, (k + 1) * kSides + i, k * kSides + i});
    }
  }
  return modelling::welded(mesh);
}

/// A cross-section of a fin: its position on the spine, its extent in front of and behind that
/// point along x, and its thickness.
struct Blade {
  glm::dvec3 spine;
  double front, back, thickness;
};

/// Returns a fin from its root to its tip, with a lens of six corners as each cross-section.
/// `across` is the direction of its thickness.
modelling::PolygonMesh fin(std::span<const Blade> blades, const glm::dvec3& tip,
                           const glm::dvec3& across) {
  constexpr std::uint32_t kCorners = 6;
  modelling::PolygonMesh mesh;
  for (const Blade& blade : blades) {
    const glm::dvec3 half = 0.5 * blade.thickness * across;
    const glm::dvec3 front = blade.spine + glm::dvec3(blade.front, 0.0, 0.0);
    const glm::dvec3 back = blade.spine - glm::dvec3(blade.back, 0.0, 0.0);
    for (const glm::dvec3& place :
         {front, glm::mix(front, back, 0.3) + half, glm::mix(front, back, 0.7) + 0.6 * half, back,
          glm::mix(front, back, 0.7) - 0.6 * half, glm::mix(front, back, 0.3) - half}) {
      mesh.vertices.push_back(place);
    }
  }
  mesh.vertices.push_back(tip);
  const auto last = static_cast<std::uint32_t>(blades.size() - 1);
  for (std::uint32_t i = 0; i < kCorners; ++i) {
    const std::uint32_t next = (i + 1) % kCorners;
    for (std::uint32_t k = 0; k < last; ++k) {
      mesh.polygons.push_back({k * kCorners + i, k * kCorners + next, (k + 1) * kCorners + next,
                               (k + 1) * kCorners + i});
    }
    mesh.polygons.push_back({last * kCorners + i, last * kCorners + next,
                             static_cast<std::uint32_t>(mesh.vertices.size() - 1)});
  }
  return mesh;
}

modelling::PolygonMesh dorsal_fin() {
  constexpr std::array<Blade, 4> kBlades = {{{{-0.01, 0.0, 0.082}, 0.080, 0.075, 0.030},
                                             {{-0.04, 0.0, 0.115}, 0.058, 0.045, 0.022},
                                             {{-0.07, 0.0, 0.150}, 0.040, 0.026, 0.014},
                                             {{-0.095, 0.0, 0.172}, 0.026, 0.016, 0.008}}};
  return fin(kBlades, {-0.128, 0.0, 0.188}, {0.0, 1.0, 0.0});
}

modelling::PolygonMesh flipper() {
  constexpr std::array<Blade, 4> kBlades = {{{{0.225, 0.058, -0.050}, 0.045, 0.042, 0.026},
                                             {{0.200, 0.105, -0.078}, 0.038, 0.034, 0.018},
                                             {{0.165, 0.145, -0.102}, 0.030, 0.026, 0.012},
                                             {{0.130, 0.172, -0.118}, 0.020, 0.016, 0.008}}};
  return modelling::turned_inside_out(fin(kBlades, {0.090, 0.192, -0.128}, {0.0, 0.5, 0.86}));
}

modelling::PolygonMesh fluke() {
  constexpr std::array<Blade, 4> kBlades = {{{{-0.440, 0.004, 0.003}, 0.040, 0.042, 0.016},
                                             {{-0.455, 0.052, 0.003}, 0.034, 0.032, 0.013},
                                             {{-0.478, 0.100, 0.004}, 0.026, 0.022, 0.010},
                                             {{-0.500, 0.132, 0.006}, 0.016, 0.013, 0.006}}};
  return modelling::turned_inside_out(fin(kBlades, {-0.530, 0.158, 0.009}, {0.0, 0.0, 1.0}));
}

modelling::PolygonMesh mirrored(modelling::PolygonMesh mesh) {
  for (glm::dvec3& vertex : mesh.vertices) vertex.y = -vertex.y;
  return modelling::turned_inside_out(std::move(mesh));
}

/// Bends the x axis to an arc of `angle` radians over a length of 1, toward -`up`.
glm::dvec3 bent(const glm::dvec3& place, double angle, int up) {
  if (angle == 0.0) return place;
  const double radius = 1.0 / angle;
  const double height = radius + place[up];
  glm::dvec3 result = place;
  result.x = height * portable_sin(place.x * angle);
  result[up] = height * portable_cos(place.x * angle) - radius;
  return result;
}

bool is_pale(const modelling::PolygonMesh& mesh, const modelling::PolygonMesh::Corners& corners) {
  const glm::dvec3 normal = glm::normalize(modelling::area_normal(mesh, corners));
  double height = 0.0;
  for (const std::uint32_t corner : corners) {
    height += mesh.vertices[corner].z / static_cast<double>(corners.size());
  }
  return normal.z < -0.1 && height < 0.02;
}

Dolphin dolphin(const DolphinPose& pose, std::size_t triangles) {
  Dolphin result;
  modelling::PolygonMesh& mesh = result.mesh;
  mesh = body();
  modelling::append(mesh, dorsal_fin());
  for (const modelling::PolygonMesh& side : {flipper(), fluke()}) {
    modelling::append(mesh, side);
    modelling::append(mesh, mirrored(side));
  }
  mesh = modelling::subdivided_to(modelling::triangulated(mesh), triangles);
  for (const auto& corners : mesh.polygons) result.belly.push_back(is_pale(mesh, corners));
  for (glm::dvec3& vertex : mesh.vertices) {
    vertex = bent(bent(vertex, pose.arch, 2), pose.turn, 1);
  }
  return result;
}

constexpr double kLength = 0.5;

struct Swimmer {
  glm::dvec3 place;
  double heading, climb, roll;  ///< degrees: about z, then head up, then about the long axis
  DolphinPose pose;
};

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  Camera camera;
  camera.from = {0.4F, -2.6F, 0.4F};
  camera.at = {0.0F, 0.0F, 0.0F};
  camera.up = {0.0F, 0.0F, 1.0F};
  camera.angle = 22.0F;
  camera.aspect = 1.25F;
  camera.width = 640;
  camera.height = 512;
  builder.add_camera(camera);
  builder.set_background({0.07, 0.30, 0.52});
  builder.add_light({-2.0, -3.0, 5.0});
  builder.add_light({2.0, -3.0, 1.0}, glm::dvec3(0.4));

  constexpr std::array<Swimmer, 3> kSwimmers = {
      {{{-0.35, -0.30, -0.25}, 190.0, 10.0, 5.0, {0.5, 0.15}},
       {{0.35, 0.00, 0.00}, 30.0, -10.0, 15.0, {0.7, -0.1}},
       {{-0.25, 0.30, 0.30}, -30.0, 20.0, 0.0, {0.6, 0.2}}}};
  constexpr Surface kBack{
      .color = {0.34F, 0.45F, 0.56F}, .diffuse = 0.75F, .specular = 0.35F, .shine = 25.0F};
  constexpr Surface kBelly{
      .color = {0.86F, 0.90F, 0.92F}, .diffuse = 0.75F, .specular = 0.25F, .shine = 25.0F};
  for (const Swimmer& swimmer : kSwimmers) {
    glm::dmat4 place = glm::translate(glm::dmat4(1.0), swimmer.place);
    place *= modelling::rotation(2, swimmer.heading);
    place *= modelling::rotation(1, -swimmer.climb);
    place *= modelling::rotation(0, swimmer.roll);
    place = glm::scale(place, glm::dvec3(kLength));
    const Dolphin body = dolphin(swimmer.pose, 564);
    const modelling::PolygonMesh mesh = modelling::transformed(body.mesh, place);
    modelling::add_smooth(builder, mesh,
                          {.paint = [&](std::size_t i) { return body.belly[i] ? kBelly : kBack; }});
  }
  return std::move(builder).build();
}

}  // namespace

// The thesis's own scene is lost. The thesis describes 1,692 polygons: three dolphins in "three
// clearly separate places" (section 5.3.1). Nothing is fitted to the thesis's counts and times for
// this scene.
void register_delfines(Catalogue& catalogue) {
  catalogue.add({"delfines",
                 "The thesis's Delfines: three dolphins in three clearly separate places",
                 {},
                 generate});
}

}  // namespace beambench::scenes::generators
