#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "scenes/catalogue.hpp"
#include "scenes/modelling/add_mesh.hpp"
#include "scenes/modelling/extrusion.hpp"
#include "scenes/modelling/lathe.hpp"
#include "scenes/modelling/polygon_mesh.hpp"
#include "scenes/modelling/subdivide.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr std::size_t kPolygons = 956;
constexpr int kSides = 24;

constexpr Surface kWhite{
    .color = {0.90F, 0.91F, 0.92F}, .diffuse = 0.8F, .specular = 0.25F, .shine = 30.0F};
constexpr Surface kRed{
    .color = {0.82F, 0.14F, 0.12F}, .diffuse = 0.8F, .specular = 0.25F, .shine = 30.0F};
constexpr Surface kGray{
    .color = {0.30F, 0.33F, 0.37F}, .diffuse = 0.7F, .specular = 0.4F, .shine = 20.0F};
constexpr Surface kDark{.color = {0.10F, 0.10F, 0.11F}, .diffuse = 0.8F};

/// A part of the missile, which stands on z = 0 with its tip at 10: a lathe with its own color.
struct Part {
  Surface surface;
  std::vector<glm::dvec2> profile;
};

std::vector<Part> hull() {
  return {{kDark, {{0.0, 0.75}, {0.22, 0.70}, {0.48, 0.0}}},
          {kGray, {{0.48, 0.0}, {0.52, 0.0}, {0.36, 0.60}, {0.70, 0.60}, {0.70, 0.95}}},
          {kWhite, {{0.70, 0.95}, {0.70, 1.9}, {0.70, 2.85}, {0.70, 3.8}}},
          {kRed, {{0.70, 3.8}, {0.73, 3.9}, {0.73, 4.3}, {0.70, 4.4}}},
          {kWhite, {{0.70, 4.4}, {0.70, 5.3}, {0.70, 6.2}, {0.70, 7.1}}},
          {kGray, {{0.70, 7.1}, {0.67, 7.16}, {0.67, 7.30}, {0.70, 7.36}}},
          {kRed,
           {{0.70, 7.36},
            {0.675, 7.90},
            {0.61, 8.45},
            {0.49, 9.00},
            {0.32, 9.50},
            {0.13, 9.85},
            {0.0, 10.0}}}};
}

/// Returns a fin in the plane y = 0, with its root on the hull at x = 0.7, slightly sunk in.
modelling::PolygonMesh fin(const std::vector<glm::dvec2>& outline, double thickness) {
  modelling::PolygonMesh mesh = modelling::extruded(modelling::flat_polygon(outline), thickness);
  std::erase_if(mesh.polygons,
                [&](const modelling::PolygonMesh::Corners& corners) {  // the root's wall
                  for (const std::uint32_t corner : corners) {
                    if (mesh.vertices[corner].x > outline.front().x) return false;
                  }
                  return true;
                });
  // The extrusion's plane (x, y) becomes (x, z).
  return modelling::transformed(
      std::move(mesh), modelling::rotation(0, 90.0) *
                           glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 0.0, -0.5 * thickness)));
}

/// Returns four copies of a fin around the hull, an eighth of a turn from the axes.
modelling::PolygonMesh four(const modelling::PolygonMesh& one) {
  modelling::PolygonMesh mesh;
  for (int i = 0; i < 4; ++i)
    modelling::append(mesh, modelling::transformed(one, modelling::rotation(2, 45.0 + 90.0 * i)));
  return mesh;
}

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  builder.add_camera({.from = {9.5F, -19.0F, 9.5F},
                      .at = {0.0F, 0.0F, 4.9F},
                      .up = {0.35F, 0.0F, 1.0F},
                      .angle = 29.0F});
  builder.set_background({0.45, 0.66, 0.88});
  builder.add_light({30.0, -20.0, 30.0}, glm::dvec3(0.8));
  builder.add_light({-20.0, -30.0, 5.0}, glm::dvec3(0.4));

  for (const Part& part : hull()) {
    builder.set_surface(part.surface);
    modelling::add_smooth(builder, modelling::lathe(part.profile, kSides));
  }
  const modelling::PolygonMesh wings =
      four(fin({{0.68, 4.9}, {1.75, 4.55}, {1.75, 4.80}, {0.68, 6.3}}, 0.06));
  builder.set_surface(kGray);
  modelling::add_flat(builder, modelling::triangulated(wings));
  const modelling::PolygonMesh tail =
      four(fin({{0.68, 0.85}, {0.9, 0.55}, {2.1, 0.05}, {2.1, 0.95}, {0.68, 2.7}}, 0.08));
  builder.set_surface(kRed);
  modelling::add_flat(builder, modelling::subdivided_to(modelling::triangulated(tail),
                                                        kPolygons - builder.primitive_count()));
  return std::move(builder).build();
}

}  // namespace

void register_misil(Catalogue& catalogue) {
  catalogue.add({"misil", "The thesis's Misil: a missile of 956 polygons", {}, generate});
}

}  // namespace beambench::scenes::generators
