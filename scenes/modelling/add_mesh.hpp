#pragma once
// A mesh into the scene.

#include "scenes/modelling/polygon_mesh.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench {

/// Adds every polygon, over shared vertices, with the builder's current surface.
void add_flat(SceneBuilder& builder, const PolygonMesh& mesh);

/// The same as smooth polygons: a corner's normal is the mean, weighted by area, of the polygons at
/// that vertex whose own normals differ by less than `crease` degrees from this polygon's; sharper
/// edges stay sharp.
void add_smooth(SceneBuilder& builder, const PolygonMesh& mesh, double crease = 50.0);

}  // namespace beambench
