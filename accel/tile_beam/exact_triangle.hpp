#pragma once
// Computes a triangle's image in double, for cases in which float is too inaccurate.

#include <array>
#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "accel/core/canonical_ray.hpp"
#include "accel/tile_beam/pencil_unit.hpp"
#include "accel/tile_beam/tile_image.hpp"
#include "accel/tile_beam/tile_view.hpp"

namespace beambench::accel::tile_beam {

/// The condition for a sample of the box to hit a triangle: no edge is negative. The plane is then
/// 1/t.
struct ExactTriangle {
  std::array<TileLine, 3> edges;
  TileLine plane;
  SampleRectangle box;
  bool at_eye;  ///< the triangle has no image: edges and plane are unset, and rays decide
};

/// Computes the image of any triangle, including slivers and triangles that cross the eye's plane
/// perpendicular to the view or extend far beyond the tile. Homogeneous coordinates need no
/// clipping (Olano and Greer, "Triangle Scan Conversion using 2D Homogeneous Coordinates", 1997).
/// Returns nothing if no sample of the tile can hit it. The edges are moved outward by
/// kEdgeWidening. A triangle that contains the eye is hit at t = 0 in any direction and has no
/// image.
std::optional<ExactTriangle> exact_triangle(const TileView& view,
                                            const std::array<glm::vec3, 3>& corners);

/// A triangle seen through a side of the cube around a pencil's apex. It is visible at a place (u,
/// v) within the bounds if no edge is negative, where an edge is x * u + y * v + z; its w there is
/// the plane's value divided by `distance`, which is positive. The bounds cut off acute corners.
struct ExactApexTriangle {
  glm::dvec2 low;
  glm::dvec2 high;
  std::array<glm::dvec3, 3> edges;
  std::array<double, 3> clear;  ///< places with at least this value of an edge are certainly inside
  glm::dvec3 plane;
  double distance;
  double distance_to_plane;  ///< from the apex
  bool at_apex;              ///< nothing else is set, and rays decide
};

/// Does the same as `exact_triangle` from an apex; edges are moved outward by more than the error
/// of float edges.
std::optional<ExactApexTriangle> exact_apex_triangle(const glm::vec3& apex, const CubeSide& side,
                                                     const std::array<glm::vec3, 3>& corners);

/// The plane of a triangle, with the arithmetic of the canonical test.
class TrianglePlane {
 public:
  explicit TrianglePlane(const std::array<glm::vec3, 3>& corners);

  /// Returns the canonical t at which the ray meets the plane, inside or outside the triangle, or
  /// kMiss.
  float hit(const Ray& ray) const;

 private:
  glm::dvec3 first_;
  glm::dvec3 normal_;
};

}  // namespace beambench::accel::tile_beam
