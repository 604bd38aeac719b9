#include "accel/core/least_references.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scenes/primitive.hpp"

namespace beambench::accel {
namespace {

double largest(const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); }

/// Returns the projected areas, along each axis, of a polygon's largest triangle.
glm::dvec3 projected_areas(const scenes::Scene& scene, const scenes::Polygon& polygon,
                           const glm::dvec3& faces) {
  glm::dvec3 most(0.0);
  for (std::uint32_t i = 0; i < polygon.triangle_count; ++i) {
    const auto& vertex = scene.triangles[polygon.first_triangle + i].vertex;
    const glm::dvec3 corner(scene.vertices[vertex[0]]);
    const glm::dvec3 areas =
        0.5 * glm::abs(glm::cross(glm::dvec3(scene.vertices[vertex[1]]) - corner,
                                  glm::dvec3(scene.vertices[vertex[2]]) - corner));
    if (largest(areas / faces) > largest(most / faces)) most = areas;
  }
  return most;
}

/// Returns a lower bound of the projected areas of a cone's lateral surface. Seen along an axis,
/// the surface covers at least the section through the cone's own axis, minus what is visible
/// through both open ends, or the ring between the ends.
glm::dvec3 projected_areas(const scenes::Cone& cone) {
  const glm::dvec3 along = glm::dvec3(cone.apex) - glm::dvec3(cone.base);
  const double length = glm::length(along);
  const double base = cone.base_radius;
  const double apex = cone.apex_radius;
  const double opening = std::numbers::pi * std::min(base, apex) * std::min(base, apex);
  const double ring = std::numbers::pi * std::abs(base * base - apex * apex);
  glm::dvec3 areas(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    const double cosine = std::min(std::abs(along[axis]) / length, 1.0);
    const double sine = std::sqrt(1.0 - cosine * cosine);
    areas[axis] = std::max((base + apex) * length * sine - opening * cosine, ring * cosine);
  }
  return areas;
}

/// Returns lower bounds of the projected areas of a primitive's surface along each axis; `faces`
/// are the areas of a cell's faces across each axis.
glm::dvec3 projected_areas(const scenes::Scene& scene, scenes::PrimitiveId id,
                           const glm::dvec3& faces) {
  const scenes::Primitive& primitive = scene.primitives[id];
  switch (primitive.kind) {
    case scenes::PrimitiveKind::kSphere: {
      const double radius = scene.spheres[primitive.index].radius;
      return glm::dvec3(std::numbers::pi * radius * radius);
    }
    case scenes::PrimitiveKind::kCone:
      return projected_areas(scene.cones[primitive.index]);
    case scenes::PrimitiveKind::kPolygon:
      return projected_areas(scene, scene.polygons[primitive.index], faces);
  }
  return glm::dvec3(0.0);
}

/// Returns a lower bound of the number of cell edges that a sphere crosses: two for each grid line
/// that, seen along its axis, lies at least half a cell's diagonal inside the sphere's outline. The
/// part of such a line inside the sphere is longer than a cell, so the sphere crosses two of the
/// cell edges on the line, each once.
double crossed_edges(const scenes::Sphere& sphere, const glm::dvec3& cell,
                     const glm::dvec3& faces) {
  double edges = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double half = std::min(0.5 * cell[axis], double{sphere.radius});
    const double long_inside = std::sqrt(double{sphere.radius} * sphere.radius - half * half);
    const double margin = 0.5 * std::hypot(cell[(axis + 1) % 3], cell[(axis + 2) % 3]);
    const double radius = std::max(long_inside - margin, 0.0);
    edges += 2.0 * std::numbers::pi * radius * radius / faces[axis];
  }
  return edges;
}

/// The minimum number of cells per crossed edge. A sphere that crosses an edge once overlaps the
/// four cells around it, and it crosses at most six edges of one cell: a cell's corners lie on a
/// sphere, so a plane separates those inside, and a plane crosses at most six edges.
constexpr double kCellsPerCrossedEdge = 4.0 / 6.0;

}  // namespace

double least_cells(const scenes::Scene& scene, scenes::PrimitiveId id, const glm::dvec3& cell) {
  constexpr double kRounding = 1.0 - 1e-6;  // of floats and of the box, with an ample margin
  const glm::dvec3 faces{cell.y * cell.z, cell.z * cell.x, cell.x * cell.y};
  const glm::dvec3 extent(scenes::primitive_bounds(scene, id).extent());
  double most =
      std::max(largest(projected_areas(scene, id, faces) / faces), largest(extent / cell));
  const scenes::Primitive& primitive = scene.primitives[id];
  if (primitive.kind == scenes::PrimitiveKind::kSphere) {
    const scenes::Sphere& sphere = scene.spheres[primitive.index];
    most = std::max(most, kCellsPerCrossedEdge * crossed_edges(sphere, cell, faces));
  }
  return std::max(kRounding * most, 1.0);
}

double least_references(const scenes::Scene& scene, const CellGrid& grid) {
  double references = 0.0;
  for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    references += least_cells(scene, id, grid.cell);
  }
  return references;
}

// The first check is made at 64 references per primitive, where computing the lower bound takes
// negligible time, plus 65,536, which small scenes reach in a few milliseconds.
ReferenceLimit::ReferenceLimit(std::uint64_t most, const scenes::Scene& scene,
                               std::function<bool()> will_exceed)
    : most_(most),
      next_(std::min(most, (std::uint64_t{1} << 16U) + 64 * scene.primitives.size())),
      will_exceed_(std::move(will_exceed)) {}

ReferenceLimit::ReferenceLimit(std::uint64_t most, const scenes::Scene& scene, const CellGrid& grid)
    : ReferenceLimit(most, scene, [most, &scene, &grid] {
        return least_references(scene, grid) > static_cast<double>(most);
      }) {}

bool ReferenceLimit::is_too_much(std::uint64_t made) {
  if (next_ < most_) {
    next_ = most_;
    if (will_exceed_()) return true;
  }
  return made > most_;
}

}  // namespace beambench::accel
