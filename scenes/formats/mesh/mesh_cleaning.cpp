#include "scenes/formats/mesh/mesh_cleaning.hpp"

#define XXH_INLINE_ALL
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <xxhash.h>

#include "scenes/base/error.hpp"
#include "scenes/scene_builder.hpp"
#include "scenes/triangulate.hpp"

namespace beambench::scenes::mesh {
namespace {

constexpr std::uint32_t kFree = std::numeric_limits<std::uint32_t>::max();

/// Turns -0 into 0, so that equal positions have equal bits; throws if the position is invalid in a
/// scene.
glm::vec3 checked(const glm::vec3& position, std::size_t triangle) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!(std::abs(position[axis]) <= static_cast<float>(kLargestNumber))) {  // catches NaN too
      throw InputError(fmt::format(
          "triangle {}: a corner has the coordinate {}, but must have numbers from -1e9 to 1e9; "
          "export the mesh again without it, or scale it",
          triangle, position[axis]));
    }
  }
  return position + 0.0F;
}

std::size_t hash_of(const glm::vec3& position) { return XXH3_64bits(&position, sizeof(position)); }

}  // namespace

SharedVertices::SharedVertices(std::vector<glm::vec3> places, bool merges)
    : places_(std::move(places)), collected_(places_.size(), kFree), merges_(merges) {}

std::optional<std::uint32_t> SharedVertices::collected(std::size_t index) const {
  return collected_[index] == kFree ? std::nullopt : std::optional(collected_[index]);
}

void MeshCollector::reserve(std::size_t vertices, std::size_t triangles) {
  mesh_.vertices.reserve(vertices);
  mesh_.triangles.reserve(triangles);
  const std::size_t slots = std::bit_ceil(2 * (vertices + 1));
  if (slots > slots_.size()) grow(slots);
}

void MeshCollector::set_surface(const Surface& surface) { surface_ = surface; }

void MeshCollector::add(const std::array<glm::vec3, 3>& corners) {
  std::array<glm::vec3, 3> places{};
  for (std::size_t i = 0; i < 3; ++i) places[i] = checked(corners[i], number());
  if (!has_area(places[0], places[1], places[2])) {
    leave_out();
    return;
  }
  push_triangle({vertex(places[0]), vertex(places[1]), vertex(places[2])});
}

void MeshCollector::add(SharedVertices& vertices, const std::array<std::uint32_t, 3>& corners) {
  std::array<glm::vec3, 3> places{};
  for (std::size_t i = 0; i < 3; ++i) {
    places[i] = checked(vertices.places_[corners[i]], number());
  }
  if (!has_area(places[0], places[1], places[2])) {
    leave_out();
    return;
  }
  std::array<std::uint32_t, 3> collected{};
  for (std::size_t i = 0; i < 3; ++i) {
    std::uint32_t& known = vertices.collected_[corners[i]];
    if (known == kFree) known = vertices.merges_ ? vertex(places[i]) : push_vertex(places[i]);
    collected[i] = known;
  }
  push_triangle(collected);
}

void MeshCollector::add_polygon(SharedVertices& vertices, std::span<const std::uint32_t> corners) {
  std::vector<glm::vec3> places;
  places.reserve(corners.size());
  for (const std::uint32_t corner : corners) {
    places.push_back(checked(vertices.places_[corner], number()));
  }
  const auto triangles = triangulate(places);
  if (triangles.empty()) leave_out();
  for (const auto& [a, b, c] : triangles) add(vertices, {corners[a], corners[b], corners[c]});
}

void MeshCollector::leave_out() {
  if (degenerate_ == 0) first_degenerate_ = number();
  ++degenerate_;
}

void MeshCollector::push_triangle(const std::array<std::uint32_t, 3>& corners) {
  if (mesh_.triangles.size() >= kFree / 3) {
    throw InputError("it has too many triangles for 32-bit indices; reduce them");
  }
  mesh_.triangles.push_back(corners);
  if (mesh_.parts.empty() || mesh_.parts.back().surface != surface_) {
    mesh_.parts.push_back({surface_, 0});
  }
  ++mesh_.parts.back().triangle_count;
}

std::uint32_t MeshCollector::vertex(const glm::vec3& position) {
  if (slots_.size() < 2 * (mesh_.vertices.size() + 1))
    grow(slots_.empty() ? 64 : 2 * slots_.size());
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash_of(position) & mask;
  for (; slots_[slot] != kFree; slot = (slot + 1) & mask) {
    if (mesh_.vertices[slots_[slot]] == position) return slots_[slot];
  }
  return slots_[slot] = push_vertex(position);
}

std::uint32_t MeshCollector::push_vertex(const glm::vec3& position) {
  mesh_.vertices.push_back(position);
  return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
}

void MeshCollector::grow(std::size_t slots) {
  const std::vector<std::uint32_t> before =
      std::exchange(slots_, std::vector<std::uint32_t>(slots, kFree));
  const std::size_t mask = slots_.size() - 1;
  for (const std::uint32_t i : before) {  // not all vertices: some are not in the table
    if (i == kFree) continue;
    std::size_t slot = hash_of(mesh_.vertices[i]) & mask;
    while (slots_[slot] != kFree) slot = (slot + 1) & mask;
    slots_[slot] = i;
  }
}

TriangleMesh MeshCollector::finish() && { return std::move(mesh_); }

}  // namespace beambench::scenes::mesh
