#include "accel/tile_beam/leaf_packer.hpp"

#include <algorithm>
#include <bit>

#include <fmt/format.h>

#include "scenes/error.hpp"

namespace beambench {
namespace {

bool same_bits(const glm::vec3& point, const Meshlet& meshlet, std::size_t vertex) {
  for (int axis = 0; axis < 3; ++axis) {
    const float other = meshlet.vertices[static_cast<std::size_t>(axis)][vertex];
    if (std::bit_cast<std::uint32_t>(point[axis]) != std::bit_cast<std::uint32_t>(other)) {
      return false;
    }
  }
  return true;
}

/// The number of a corner in a meshlet, added when it is new; kMostVertices when there is no room.
std::size_t vertex_of(Meshlet& meshlet, const glm::vec3& point) {
  for (std::size_t i = meshlet.vertex_count; i-- > 0;) {
    if (same_bits(point, meshlet, i)) return i;
  }
  if (meshlet.vertex_count == Meshlet::kMostVertices) return Meshlet::kMostVertices;
  for (int axis = 0; axis < 3; ++axis) {
    meshlet.vertices[static_cast<std::size_t>(axis)][meshlet.vertex_count] = point[axis];
  }
  return meshlet.vertex_count++;
}

/// Adds a triangle with its corners; false, and nothing added, when there is no room for it.
bool append(Meshlet& meshlet, const Scene& scene, const Triangle& triangle) {
  if (meshlet.triangle_count == Meshlet::kMostTriangles) return false;
  const std::uint32_t vertices_before = meshlet.vertex_count;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t vertex = vertex_of(meshlet, scene.vertices[triangle.vertex[i]]);
    if (vertex == Meshlet::kMostVertices) {
      meshlet.vertex_count = vertices_before;
      return false;
    }
    meshlet.corners[i][meshlet.triangle_count] = static_cast<std::uint8_t>(vertex);
  }
  meshlet.primitives[meshlet.triangle_count++] = triangle.primitive;
  return true;
}

}  // namespace

std::span<const PackedLeaf> LeafPacker::pack(std::span<const std::uint32_t> items) {
  packed_.clear();
  const auto each_of = [&](PrimitiveKind kind, auto&& add) {
    for (const std::uint32_t item : items) {
      if (scene_->primitives[pieces_[item].primitive].kind == kind) add(item);
    }
  };
  each_of(PrimitiveKind::kPolygon, [&](std::uint32_t item) { add_triangle(item); });
  each_of(PrimitiveKind::kSphere, [&](std::uint32_t item) { add_sphere(item); });
  each_of(PrimitiveKind::kCone, [&](std::uint32_t item) { add_cone(item); });
  for (const PackedLeaf& leaf : packed_) {
    if (leaf.child.kind() != TileChild::Kind::kMeshlet) continue;
    const glm::vec3 sides = leaf.box.extent();
    into_->meshlets[leaf.child.index()].extent = std::max({sides.x, sides.y, sides.z});
  }
  return packed_;
}

PackedLeaf& LeafPacker::begin(TileChild::Kind kind, std::size_t index) {
  if (index >= TileChild::kIndices) {
    throw InputError(fmt::format(
        "tile-beam over '{}' needs more than {} leaves; take a scene with fewer primitives",
        scene_->name, TileChild::kIndices));
  }
  return packed_.emplace_back(PackedLeaf{TileChild(kind, static_cast<std::uint32_t>(index)), {}});
}

void LeafPacker::add_triangle(std::uint32_t item) {
  const Triangle& triangle = scene_->triangles[pieces_[item].index];
  if (packed_.empty() || !append(into_->meshlets.back(), *scene_, triangle)) {
    begin(TileChild::Kind::kMeshlet, into_->meshlets.size());
    append(into_->meshlets.emplace_back(), *scene_, triangle);
  }
  packed_.back().box.include(boxes_[item]);
}

void LeafPacker::add_sphere(std::uint32_t item) {
  if (packed_.empty() || packed_.back().child.kind() != TileChild::Kind::kSpheres ||
      into_->spheres.back().count == kTileLanes) {
    begin(TileChild::Kind::kSpheres, into_->spheres.size());
    into_->spheres.emplace_back();
  }
  SphereBlock& block = into_->spheres.back();
  const Sphere& sphere = scene_->spheres[pieces_[item].index];
  const std::size_t lane = block.count++;
  for (int axis = 0; axis < 3; ++axis) {
    block.center[static_cast<std::size_t>(axis)][lane] = sphere.center[axis];
  }
  block.radius[lane] = sphere.radius;
  block.primitives[lane] = pieces_[item].primitive;
  if (sphere.inside_only) block.inside_only |= 1U << lane;
  packed_.back().box.include(boxes_[item]);
}

void LeafPacker::add_cone(std::uint32_t item) {
  if (packed_.empty() || packed_.back().child.kind() != TileChild::Kind::kCones ||
      into_->cones.back().count == kTileLanes) {
    begin(TileChild::Kind::kCones, into_->cones.size());
    into_->cones.emplace_back();
  }
  ConeBlock& block = into_->cones.back();
  const std::size_t lane = block.count++;
  block.boxes.set(lane, boxes_[item]);
  block.primitives[lane] = pieces_[item].primitive;
  packed_.back().box.include(boxes_[item]);
}

}  // namespace beambench
