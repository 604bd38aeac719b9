#pragma once
// The modelling kit's value, and how the pieces of the kit fit together.
//
// A generator models in double and hands the result to a `SceneBuilder`, which rounds once:
//   polygon_mesh.hpp        the value; append, transformed, mirrored windings set right
//   extrusion.hpp           a flat shape drawn out: plates, fins, letters' bodies
//   letters.hpp             extruded capital letters
//   box.hpp                 box, bevelled box
//   lathe.hpp               a profile revolved about z
//   sweep.hpp               an outline or a circle drawn along a path
//   parametric_surface.hpp  a grid of quads over a function of two parameters; ellipsoid
//   weld.hpp                coincident vertices made one
//   subdivide.hpp           triangulated; subdivided_to: exactly n polygons
//   rotation.hpp            for `transformed`, with the same bits everywhere
//   add_mesh.hpp            into the scene, flat or smooth
// Pieces take and return values, look outward (counter-clockwise seen from outside) and hold only
// surfaces that can be seen: caps and bottoms are left out where the caller says so. A scene counts
// its polygons once it is whole: model with a few polygons less than wanted, then
// `subdivided_to(mesh, n)`.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace beambench::scenes::modelling {

/// Polygons over shared vertices. A polygon lists its corners counter-clockwise seen from outside;
/// it may be concave but is (nearly) flat. Vertices may be unused.
struct PolygonMesh {
  using Corners = std::vector<std::uint32_t>;

  std::vector<glm::dvec3> vertices;
  std::vector<Corners> polygons;

  std::size_t size() const { return polygons.size(); }
};

/// Adds all of `more`; its vertices stay its own.
void append(PolygonMesh& mesh, const PolygonMesh& more);

/// The mesh moved by an affine transform; windings are turned round where it mirrors.
PolygonMesh transformed(PolygonMesh mesh, const glm::dmat4& transform);

/// The mesh seen from the other side: every winding turned round.
PolygonMesh turned_inside_out(PolygonMesh mesh);

/// Newell's normal of a polygon, its length being twice the polygon's area.
glm::dvec3 area_normal(const PolygonMesh& mesh, const PolygonMesh::Corners& corners);

}  // namespace beambench::scenes::modelling
