#pragma once
// Rounded bodies that grow into one another: the surface where a field is zero.

#include <functional>

#include "scenes/modelling/polygon_mesh.hpp"

namespace beambench::scenes::modelling {

/// The approximate distance to a body, negative inside.
using Field = std::function<double(const glm::dvec3&)>;

/// Returns the field of an axis-aligned ellipsoid, exact on its surface.
double ellipsoid_field(const glm::dvec3& place, const glm::dvec3& center,
                       const glm::dvec3& half_axes);
/// A limb: the balls of radii between `from_radius` and `to_radius` along a line.
struct Limb {
  glm::dvec3 from;
  double from_radius;
  glm::dvec3 to;
  double to_radius;
};
double limb_field(const glm::dvec3& place, const Limb& limb);
/// Returns the union of two bodies, with the seam filled in over a distance of about `blend`.
double joined(double a, double b, double blend);

/// Returns the surface of the field inside a box, as quads. Their corners lie on the surface, one
/// for each cube of side `cell` that the surface crosses (surface nets: Gibson 1998). The quads
/// face the positive side of the field. The body must end inside the box and be thicker than a
/// cell.
PolygonMesh implicit_surface(const Field& field, const glm::dvec3& lower, const glm::dvec3& upper,
                             double cell);

/// Returns the number of the color region that a point of the surface belongs to.
using Region = std::function<int(const glm::dvec3&)>;

/// Moves vertices of triangles along the surface onto the borders between regions, so that borders
/// follow edges wherever this does not flip a triangle.
PolygonMesh drawn_to_borders(PolygonMesh mesh, const Field& surface, const Region& region);

/// Returns the mesh without the polygons that have all corners inside the body, for parts that
/// protrude from a body.
PolygonMesh outside(const PolygonMesh& mesh, const Field& body);

/// Returns the mean of a polygon's corners.
glm::dvec3 middle(const PolygonMesh& mesh, std::size_t polygon);

}  // namespace beambench::scenes::modelling
