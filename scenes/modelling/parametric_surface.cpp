#include "scenes/modelling/parametric_surface.hpp"

#include <numbers>
#include <vector>

#include "scenes/base/portable_math.hpp"
#include "scenes/modelling/lathe.hpp"
#include "scenes/modelling/polygon_mesh.hpp"

namespace beambench::scenes::modelling {

PolygonMesh parametric_surface(const SurfaceFunction& surface, int u_steps, int v_steps) {
  PolygonMesh mesh;
  for (int v = 0; v <= v_steps; ++v) {
    for (int u = 0; u <= u_steps; ++u) {
      mesh.vertices.push_back(
          surface(static_cast<double>(u) / u_steps, static_cast<double>(v) / v_steps));
    }
  }
  const auto row = static_cast<std::uint32_t>(u_steps + 1);
  for (std::uint32_t v = 0; v < static_cast<std::uint32_t>(v_steps); ++v) {
    for (std::uint32_t u = 0; u + 1 < row; ++u) {
      const std::uint32_t corner = v * row + u;
      mesh.polygons.push_back({corner, corner + 1, corner + row + 1, corner + row});
    }
  }
  return welded(mesh);
}

PolygonMesh ellipsoid(const glm::dvec3& half_axes, int slices, int stacks) {
  std::vector<glm::dvec2> profile = {{0.0, -1.0}};
  for (int i = 1; i < stacks; ++i) {
    const double angle = std::numbers::pi * i / stacks;
    profile.emplace_back(portable_sin(angle), -portable_cos(angle));
  }
  profile.emplace_back(0.0, 1.0);
  PolygonMesh mesh = lathe(profile, slices);
  for (glm::dvec3& vertex : mesh.vertices) vertex *= half_axes;
  return mesh;
}

}  // namespace beambench::scenes::modelling
