#include "harness/explain/display_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include <glm/geometric.hpp>

namespace beambench::explain {
namespace {

constexpr std::uint32_t kSidesOfCone = 16;

void add_cone(const scenes::Cone& cone, scenes::PrimitiveId id, DisplayMesh& mesh) {
  const glm::vec3 axis = glm::normalize(cone.apex - cone.base);
  const glm::vec3 other = std::abs(axis.x) < 0.5F ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  const glm::vec3 u = glm::normalize(glm::cross(axis, other));
  const glm::vec3 v = glm::cross(axis, u);
  const auto first = static_cast<std::uint32_t>(mesh.corners.size());
  for (std::uint32_t i = 0; i < kSidesOfCone; ++i) {
    const float angle = 2.0F * std::numbers::pi_v<float> * static_cast<float>(i) / kSidesOfCone;
    const glm::vec3 out = std::cos(angle) * u + std::sin(angle) * v;
    mesh.corners.push_back(cone.base + cone.base_radius * out);
    mesh.corners.push_back(cone.apex + cone.apex_radius * out);
    const std::uint32_t a = first + 2 * i;
    const std::uint32_t b = first + 2 * ((i + 1) % kSidesOfCone);
    if (cone.base_radius > 0.0F) mesh.triangles.push_back({a, b, a + 1});
    if (cone.apex_radius > 0.0F) mesh.triangles.push_back({b, b + 1, a + 1});
  }
  mesh.primitives.resize(mesh.triangles.size(), id);
}

/// Merges the corners in each cell of a grid of `cells` along the longest axis.
DisplayMesh merged(const DisplayMesh& mesh, const scenes::Bounds& bounds, double cells) {
  const glm::vec3 extent = bounds.extent();
  const auto side = static_cast<float>(std::max({extent.x, extent.y, extent.z}) / cells);
  std::unordered_map<std::uint64_t, std::uint32_t> corner_of_cell;
  std::vector<std::uint32_t> renamed;
  DisplayMesh out;
  out.triangles_of_scene = mesh.triangles_of_scene;
  renamed.reserve(mesh.corners.size());
  for (const glm::vec3& corner : mesh.corners) {
    std::uint64_t cell = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float place = side > 0.0F ? (corner[axis] - bounds.lower[axis]) / side : 0.0F;
      cell = cell << 20U | static_cast<std::uint64_t>(std::max(place, 0.0F));
    }
    const auto [entry, is_new] =
        corner_of_cell.try_emplace(cell, static_cast<std::uint32_t>(out.corners.size()));
    if (is_new) out.corners.push_back(corner);
    renamed.push_back(entry->second);
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    std::array<std::uint32_t, 3> triangle = mesh.triangles[i];
    for (std::uint32_t& corner : triangle) corner = renamed[corner];
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) {
      continue;
    }
    out.triangles.push_back(triangle);
    out.primitives.push_back(mesh.primitives[i]);
  }
  return out;
}

}  // namespace

DisplayMesh display_mesh(const scenes::Scene& scene, std::size_t most) {
  DisplayMesh mesh;
  mesh.corners = scene.vertices;
  for (const scenes::Triangle& triangle : scene.triangles) {
    mesh.triangles.push_back(triangle.vertex);
    mesh.primitives.push_back(triangle.primitive);
  }
  for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    const scenes::Primitive& primitive = scene.primitives[id];
    if (primitive.kind != scenes::PrimitiveKind::kCone) continue;
    add_cone(scene.cones[primitive.index], id, mesh);
  }
  mesh.triangles_of_scene = mesh.triangles.size();
  constexpr double kFinest = 2048.0;
  constexpr double kCoarser = 0.7;
  DisplayMesh shown = mesh;
  for (double cells = kFinest; shown.triangles.size() > most && cells >= 1.0; cells *= kCoarser) {
    shown = merged(mesh, scene.bounds, cells);
  }
  return shown;
}

}  // namespace beambench::explain
