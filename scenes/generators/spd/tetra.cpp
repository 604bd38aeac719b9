#include <array>

#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

/// The corners of the cube [-1, 1]^3 whose coordinates multiply to +1: a regular tetrahedron.
constexpr std::array<glm::dvec3, 4> kCorners = {
    {{1.0, 1.0, 1.0}, {1.0, -1.0, -1.0}, {-1.0, 1.0, -1.0}, {-1.0, -1.0, 1.0}}};
/// The tetrahedron's faces, counter-clockwise seen from outside; face i is opposite corner i.
constexpr std::array<std::array<int, 3>, 4> kFaces = {{{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}}};

void add_tetrahedron(SceneBuilder& builder, const glm::dvec3& center, double half_size) {
  std::array<std::uint32_t, 4> vertices{};
  for (std::size_t i = 0; i < 4; ++i) {
    vertices[i] = builder.add_vertex(center + half_size * kCorners[i]);
  }
  for (const auto& [a, b, c] : kFaces) {
    const std::array<std::uint32_t, 3> face = {vertices[static_cast<std::size_t>(a)],
                                               vertices[static_cast<std::size_t>(b)],
                                               vertices[static_cast<std::size_t>(c)]};
    builder.add_polygon(face);
  }
}

/// Adds 4^levels tetrahedra that touch at their corners.
void add_tetrahedra(SceneBuilder& builder, const glm::dvec3& center, double half_size,
                    std::int64_t levels) {
  if (levels == 0) return add_tetrahedron(builder, center, half_size);
  for (const glm::dvec3& corner : kCorners) {
    add_tetrahedra(builder, center + 0.5 * half_size * corner, 0.5 * half_size, levels - 1);
  }
}

Scene generate(const std::string& name, std::int64_t n) {
  SceneBuilder builder(name);
  Camera camera;
  camera.from = {1.022846F, -3.177154F, -2.174512F};
  camera.at = {-0.004103F, -0.004103F, 0.216539F};
  camera.up = {-0.816497F, -0.816497F, 0.816497F};
  camera.hither = 1.0F;
  builder.add_camera(camera);
  builder.set_background({0.078, 0.361, 0.753});
  builder.add_light({2.0, -18.0, -5.0});
  builder.set_surface({.color = {1.0F, 0.2F, 0.2F}});
  add_tetrahedra(builder, glm::dvec3(0.0), 1.0, n - 1);
  return std::move(builder).build();
}

}  // namespace

void register_tetra(Catalogue& catalogue) {
  catalogue.add({"tetra",
                 "Recursive tetrahedra of 4^n triangles (Haines's SPD)",
                 {integer_parameter("n", 6, 1, 12, "levels; each quadruples the triangles")},
                 [](const Parameters& p) { return generate(p.label(), p.integer("n")); },
                 "n"});
  catalogue.add({"stetra",
                 "The thesis's Stetra: recursive tetrahedra of 256 triangles, tetra:n=4",
                 {},
                 [](const Parameters& p) { return generate(p.label(), 4); }});
}

}  // namespace beambench::scenes::generators
