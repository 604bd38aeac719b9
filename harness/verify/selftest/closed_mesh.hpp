#pragma once
// A closed mesh of triangles, and rays over it that are hard to trace.

#include <array>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/ray.hpp"
#include "scenes/base/random.hpp"
#include "scenes/scene.hpp"

namespace beambench::verify {

/// A bumpy ball of about a thousand triangles that share their vertices: a ray from inside cannot
/// leave it without a hit.
struct ClosedMesh {
  scenes::Scene scene;
  glm::dvec3 center;
  double radius;  ///< vertices are 0.8 to 1.2 times as far from the center
};
ClosedMesh closed_mesh(const glm::dvec3& center, double radius);

/// A place and a size of the mesh.
struct MeshPlace {
  const char* family;  ///< the family in the kit
  glm::dvec3 center;
  double radius;
};
inline constexpr std::array<MeshPlace, 4> kMeshPlaces{{{"closed mesh", {10.0, -3.0, 7.0}, 2.0},
                                                       {"huge scale", {2e5, -1e6, 3e5}, 1e6},
                                                       {"huge scale", {3e8, 0.0, -2e8}, 5e7},
                                                       {"tiny scale", {1e-7, 0.0, -2e-7}, 1e-6}}};

/// Returns a vertex, or the middle of an edge, of a random triangle.
glm::dvec3 vertex_or_edge(const scenes::Scene& scene, Random& random);

/// Returns rays from within half the radius of the center, most of them aimed at vertices and
/// middles of edges.
std::vector<accel::Ray> rays_from_inside(const ClosedMesh& mesh, std::uint64_t count,
                                         Random& random);
/// Returns rays from outside, aimed at vertices and middles of edges; one in three is parallel to
/// an axis.
std::vector<accel::Ray> rays_at_edges(const ClosedMesh& mesh, std::uint64_t count, Random& random);
/// Returns rays that begin on the surface, up to rounding, in any direction.
std::vector<accel::Ray> rays_from_surface(const ClosedMesh& mesh, std::uint64_t count,
                                          Random& random);
/// Returns rays whose directions have components that are -0.0 or subnormal, or lengths from 1e-12
/// to 1e8.
std::vector<accel::Ray> rays_of_odd_directions(const ClosedMesh& mesh, std::uint64_t count,
                                               Random& random);

}  // namespace beambench::verify
