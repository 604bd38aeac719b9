#pragma once
// Polygon meshes, which the functions in this folder take and return.
//
// A generator models in double and passes the result to a `SceneBuilder`, which rounds once:
//   polygon_mesh.hpp        the mesh type; append, transform, weld
//   box.hpp                 boxes, square rings, bars and bracing
//   walls.hpp               walls with openings, moldings
//   extrusion.hpp           a flat shape extruded along z: plates, fins
//   letters.hpp             extruded capital letters
//   lathe.hpp               a profile revolved about z
//   sweep.hpp               an outline or a circle swept along a path
//   parametric_surface.hpp  a grid of quads over a function of two parameters; ellipsoid
//   implicit_surface.hpp    the zero set of a field
//   subdivide.hpp           division into triangles, or into exactly n polygons
//   add_mesh.hpp            adds a mesh to the scene, flat or smooth
//
// Meshes face outward (counter-clockwise seen from outside) and hold only visible surfaces: callers
// can leave out caps and bottoms. To reach an exact number of polygons, model with slightly fewer,
// then call `subdivided_to(mesh, n)`.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "scenes/base/rotation.hpp"

namespace beambench::scenes::modelling {

/// Polygons over shared vertices. A polygon lists its corners counter-clockwise seen from outside;
/// it may be concave but is (nearly) flat. Vertices may be unused.
struct PolygonMesh {
  using Corners = std::vector<std::uint32_t>;

  std::vector<glm::dvec3> vertices;
  std::vector<Corners> polygons;

  std::size_t size() const { return polygons.size(); }
};

/// Adds all polygons of `more`, with separate vertices.
void append(PolygonMesh& mesh, const PolygonMesh& more);

/// Returns the mesh moved by an affine transform. Windings are reversed if the transform mirrors.
PolygonMesh transformed(PolygonMesh mesh, const glm::dmat4& transform);

/// Returns the mesh turned inside out: every winding reversed.
PolygonMesh turned_inside_out(PolygonMesh mesh);

/// Returns Newell's normal of a polygon; its length is twice the polygon's area.
glm::dvec3 area_normal(const PolygonMesh& mesh, const PolygonMesh::Corners& corners);

using beambench::rotation;

/// Returns the mesh with vertices closer together than 1e-9 of the mesh's largest coordinate merged
/// into the first of them, so that edges are shared. Corners that coincide with the previous one
/// are dropped, as are polygons left with fewer than three corners.
PolygonMesh welded(const PolygonMesh& mesh);

}  // namespace beambench::scenes::modelling
