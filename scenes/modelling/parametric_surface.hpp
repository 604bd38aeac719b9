#pragma once
// Surfaces over two parameters.

#include <functional>

#include "scenes/modelling/polygon_mesh.hpp"

namespace beambench::scenes::modelling {

/// Returns the point for (u, v) in [0, 1]^2. The surface faces du x dv.
using SurfaceFunction = std::function<glm::dvec3(double u, double v)>;

/// Returns a welded grid of u_steps x v_steps quads over the function. It is closed where opposite
/// edges coincide, and has triangles where a row shrinks to a point.
PolygonMesh parametric_surface(const SurfaceFunction& surface, int u_steps, int v_steps);

/// Returns the ellipsoid around the origin with these half-axes, divided into `slices` around z and
/// `stacks` from pole to pole, with triangles at the poles.
PolygonMesh ellipsoid(const glm::dvec3& half_axes, int slices, int stacks);

}  // namespace beambench::scenes::modelling
