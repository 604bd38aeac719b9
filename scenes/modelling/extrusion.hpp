#pragma once
// A flat shape extruded along z.

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

#include "scenes/modelling/polygon_mesh.hpp"

namespace beambench::scenes::modelling {

/// A shape in the plane z = 0: polygons over shared points, counter-clockwise seen from +z. A shape
/// with a hole consists of several polygons around the hole; each seam between them is an edge of
/// two polygons.
struct FlatShape {
  std::vector<glm::dvec2> points;
  std::vector<PolygonMesh::Corners> polygons;
};

/// Returns a shape of one polygon.
FlatShape flat_polygon(std::vector<glm::dvec2> points);

/// The closed ends of an extrusion.
enum class Ends : std::uint8_t { kBoth, kFront, kNone };

/// Returns the shape extruded from z = 0 (back) to z = depth (front), with a wall along every edge
/// of the outline and the holes, but not along the seams.
PolygonMesh extruded(const FlatShape& shape, double depth, Ends ends = Ends::kBoth);

}  // namespace beambench::scenes::modelling
