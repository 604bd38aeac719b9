#include "scenes/modelling/box.hpp"

#include <array>

#include <glm/geometric.hpp>

#include "scenes/modelling/sweep.hpp"

namespace beambench::scenes::modelling {
namespace {

using Corners = PolygonMesh::Corners;

/// Corner i of a box has the upper x for bit 0, y for bit 1, z for bit 2.
const std::array<Corners, 6> kFaces = {
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

std::array<glm::dvec3, 8> corners_of(const glm::dvec3& lower, const glm::dvec3& upper) {
  std::array<glm::dvec3, 8> corners;
  for (std::size_t i = 0; i < 8; ++i) {
    corners[i] = {(i & 1U) != 0 ? upper.x : lower.x, (i & 2U) != 0 ? upper.y : lower.y,
                  (i & 4U) != 0 ? upper.z : lower.z};
  }
  return corners;
}

}  // namespace

PolygonMesh box(const glm::dvec3& lower, const glm::dvec3& upper) {
  PolygonMesh mesh;
  const auto corners = corners_of(lower, upper);
  mesh.vertices.assign(corners.begin(), corners.end());
  mesh.polygons.assign(kFaces.begin(), kFaces.end());
  return mesh;
}

PolygonMesh box_without_bottom(const glm::dvec3& lower, const glm::dvec3& upper) {
  PolygonMesh mesh = box(lower, upper);
  mesh.polygons.erase(mesh.polygons.begin() + 4);
  return mesh;
}

PolygonMesh beveled_box(const glm::dvec3& lower, const glm::dvec3& upper, double bevel) {
  // Each corner becomes three vertices, 3 * corner + axis, one on the face across each axis.
  PolygonMesh mesh;
  const auto outer = corners_of(lower, upper);
  const auto inner = corners_of(lower + bevel, upper - bevel);
  for (std::size_t i = 0; i < 8; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      glm::dvec3 vertex = inner[i];
      vertex[axis] = outer[i][axis];
      mesh.vertices.push_back(vertex);
    }
  }
  for (std::uint32_t face = 0; face < 6; ++face) {
    Corners corners = kFaces[face];
    for (std::uint32_t& corner : corners) corner = 3 * corner + face / 2;
    mesh.polygons.push_back(corners);
  }
  // An edge along `axis` between the faces of the two next axes, b and c.
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    const std::uint32_t b = (axis + 1) % 3;
    const std::uint32_t c = (axis + 2) % 3;
    for (const std::uint32_t side : {0U, 1U, 2U, 3U}) {
      const std::uint32_t start = ((side & 1U) << b) | ((side >> 1U) << c);
      const std::uint32_t end = start | (1U << axis);
      Corners corners = {3 * start + b, 3 * end + b, 3 * end + c, 3 * start + c};
      if (side == 1 || side == 2) corners = Corners(corners.rbegin(), corners.rend());
      mesh.polygons.push_back(Corners(corners.rbegin(), corners.rend()));
    }
  }
  for (std::uint32_t i = 0; i < 8; ++i) {
    const bool odd = ((i ^ (i >> 1U) ^ (i >> 2U)) & 1U) != 0;
    mesh.polygons.push_back(odd ? Corners{3 * i, 3 * i + 1, 3 * i + 2}
                                : Corners{3 * i, 3 * i + 2, 3 * i + 1});
  }
  return mesh;
}

PolygonMesh square_ring(double half, double hole, double bottom, double top) {
  PolygonMesh mesh;
  for (const double z : {bottom, top}) {
    for (const double size : {half, hole}) {
      mesh.vertices.insert(
          mesh.vertices.end(),
          {{-size, -size, z}, {size, -size, z}, {size, size, z}, {-size, size, z}});
    }
  }
  for (std::uint32_t i = 0; i < 4; ++i) {  // outer corners i, inner 4 + i; upper: 8 more
    const std::uint32_t next = (i + 1) % 4;
    mesh.polygons.push_back({i, next, next + 8, i + 8});
    mesh.polygons.push_back({i + 8, next + 8, next + 12, i + 12});
    mesh.polygons.push_back({next + 4, i + 4, i + 12, next + 12});
    mesh.polygons.push_back({next, i, i + 4, next + 4});
  }
  return mesh;
}

PolygonMesh bar(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& outward,
                double thickness) {
  const std::array<glm::dvec2, 4> square = {{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}};
  const std::array<glm::dvec3, 2> path = {from, to};
  const std::array<double, 2> scales = {thickness, thickness};
  return sweep(square, path, scales, outward, Caps::kNone);
}

PolygonMesh braced_face(std::span<const glm::dvec3> left, std::span<const glm::dvec3> right,
                        const glm::dvec3& outward, const Bracing& bracing) {
  PolygonMesh mesh;
  for (std::size_t i = 0; i < left.size(); ++i) {
    append(mesh, bar(left[i], right[i], outward, bracing.crossbar));
    if (i + 1 == left.size()) break;
    append(mesh, bar(left[i], right[i + 1], outward, bracing.diagonal));
    append(mesh, bar(right[i], left[i + 1], outward, 0.85 * bracing.diagonal));
  }
  return mesh;
}

}  // namespace beambench::scenes::modelling
