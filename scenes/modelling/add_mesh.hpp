#pragma once
// Adds a mesh to a scene.

#include <cstddef>
#include <functional>

#include "scenes/modelling/polygon_mesh.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::modelling {

/// Adds all polygons of a mesh, over shared vertices, with the builder's current surface.
void add_flat(SceneBuilder& builder, const PolygonMesh& mesh);

/// Returns the surface of a polygon, given by its number in the mesh.
using Paint = std::function<Surface(std::size_t polygon)>;

/// Adds all polygons of a mesh, over shared vertices, each with its own surface.
void add_painted(SceneBuilder& builder, const PolygonMesh& mesh, const Paint& paint);

/// Options for smoothing and coloring polygons.
struct SmoothOptions {
  double crease = 50.0;  ///< degrees; sharper edges stay sharp
  Paint paint{};         ///< the surface of each polygon, if given
};

/// Adds smooth polygons. A corner's normal is the mean, weighted by area, of the normals of the
/// polygons at that vertex that differ by less than the crease angle from this polygon's normal.
void add_smooth(SceneBuilder& builder, const PolygonMesh& mesh, const SmoothOptions& options = {});

}  // namespace beambench::scenes::modelling
