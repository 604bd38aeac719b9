#include "accel/tile_beam/leaf_packer.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "scenes/base/error.hpp"

namespace beambench::accel::tile_beam {
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

/// A meshlet that triangles are added to and, if the scene moves, its vertices.
struct OpenMeshlet {
  Meshlet& meshlet;
  MeshletVertices* numbers;  ///< null if the scene does not move

  bool has(std::size_t corner, std::uint32_t vertex, const glm::vec3& place) const {
    return numbers != nullptr ? (*numbers)[corner] == vertex : same_bits(place, meshlet, corner);
  }
};

/// Returns the index of a corner in the meshlet, adding it if it is new; kMaxVertices if the
/// meshlet is full.
std::size_t corner_of(const OpenMeshlet& open, const scenes::Scene& scene, std::uint32_t vertex) {
  Meshlet& meshlet = open.meshlet;
  const glm::vec3& place = scene.vertices[vertex];
  for (std::size_t i = meshlet.vertex_count; i-- > 0;) {
    if (open.has(i, vertex, place)) return i;
  }
  if (meshlet.vertex_count == Meshlet::kMaxVertices) return Meshlet::kMaxVertices;
  for (int axis = 0; axis < 3; ++axis) {
    meshlet.vertices[static_cast<std::size_t>(axis)][meshlet.vertex_count] = place[axis];
  }
  if (open.numbers != nullptr) (*open.numbers)[meshlet.vertex_count] = vertex;
  return meshlet.vertex_count++;
}

/// Adds a triangle with its corners; returns false, without adding anything, if it does not fit.
bool append(const OpenMeshlet& open, const scenes::Scene& scene, const scenes::Triangle& triangle) {
  Meshlet& meshlet = open.meshlet;
  if (meshlet.triangle_count == Meshlet::kMaxTriangles) return false;
  const std::uint32_t vertices_before = meshlet.vertex_count;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t corner = corner_of(open, scene, triangle.vertex[i]);
    if (corner == Meshlet::kMaxVertices) {
      meshlet.vertex_count = vertices_before;
      return false;
    }
    meshlet.corners[i][meshlet.triangle_count] = static_cast<std::uint8_t>(corner);
  }
  meshlet.primitives[meshlet.triangle_count++] = triangle.primitive;
  return true;
}

void require_index(const scenes::Scene& scene, std::size_t index) {
  if (index < TileChild::kIndices) return;
  throw InputError(fmt::format(
      "tile-beam over '{}' needs more than {} leaves; use a scene with fewer primitives",
      scene.name, TileChild::kIndices));
}

/// Packs one leaf after another.
class LeafPacker {
 public:
  explicit LeafPacker(const TileParts& parts) : parts_(&parts) { made_.first.push_back(0); }

  /// Reserves memory for this many leaves of a scene's parts.
  void reserve(std::size_t leaves) {
    const std::size_t parts = parts_->parts.size();
    const scenes::Scene& scene = parts_->scene;
    made_.packed.reserve(leaves);
    made_.first.reserve(leaves + 1);
    // Allow for leaves with several blocks; unused space is never touched.
    const std::size_t blocks = leaves + leaves / 2;
    made_.blocks.meshlets.reserve(blocks * scene.triangles.size() / parts);
    made_.blocks.spheres.reserve(blocks * scene.spheres.size() / parts);
    made_.blocks.cones.reserve(blocks * scene.cones.size() / parts);
  }

  /// Packs a leaf. `items` must be ascending.
  void pack(std::span<const std::uint32_t> items) {
    const scenes::Scene& scene = parts_->scene;
    for (const auto kind : {scenes::PrimitiveKind::kPolygon, scenes::PrimitiveKind::kSphere,
                            scenes::PrimitiveKind::kCone}) {
      of_kind_.clear();
      std::ranges::copy_if(items, std::back_inserter(of_kind_), [&](std::uint32_t item) {
        return scene.primitives[parts_->parts[item].primitive].kind == kind;
      });
      if (!of_kind_.empty()) pack_blocks(kind, of_kind_);
    }
    made_.first.push_back(static_cast<std::uint32_t>(made_.packed.size()));
  }

  PackedLeaves& made() { return made_; }

 private:
  /// Packs items of one kind. If they do not fit into one block, they are halved along their
  /// longest axis: in scene order, the boxes of a leaf's blocks would overlap.
  void pack_blocks(scenes::PrimitiveKind kind, std::span<std::uint32_t> items) {
    if (pack_block(kind, items)) return;
    const auto half = static_cast<std::ptrdiff_t>(items.size() / 2);
    const auto center = [&](std::uint32_t item) {
      const scenes::Bounds& box = parts_->boxes[item];
      return box.lower + box.upper;  // twice the center
    };
    scenes::Bounds centers;
    for (const std::uint32_t item : items) centers.include(center(item));
    const glm::vec3 sides = centers.extent();
    const int axis = sides.x >= std::max(sides.y, sides.z) ? 0 : sides.y >= sides.z ? 1 : 2;
    std::nth_element(items.begin(), items.begin() + half, items.end(),
                     [&](std::uint32_t a, std::uint32_t b) {
                       return std::pair(center(a)[axis], a) < std::pair(center(b)[axis], b);
                     });
    for (const auto part : {items.first(items.size() / 2), items.subspan(items.size() / 2)}) {
      std::ranges::sort(part);
      pack_blocks(kind, part);
    }
  }

  /// Packs items of one kind into one block. Returns false, without adding anything, if they do not
  /// fit.
  bool pack_block(scenes::PrimitiveKind kind, std::span<const std::uint32_t> items) {
    scenes::Bounds box;
    for (const std::uint32_t item : items) box.include(parts_->boxes[item]);
    switch (kind) {
      case scenes::PrimitiveKind::kPolygon:
        return pack_triangles(items, box);
      case scenes::PrimitiveKind::kSphere:
        return pack_lanes(TileChild::Kind::kSpheres, made_.blocks.spheres, items, box);
      case scenes::PrimitiveKind::kCone:
        return pack_lanes(TileChild::Kind::kCones, made_.blocks.cones, items, box);
    }
    return false;
  }

  void begin(TileChild::Kind kind, std::size_t index, const scenes::Bounds& box) {
    require_index(parts_->scene, index);
    made_.packed.push_back({TileChild(kind, static_cast<std::uint32_t>(index)), box});
  }

  /// Adds spheres or cones.
  template <class Blocks>
  bool pack_lanes(TileChild::Kind kind, Blocks& blocks, std::span<const std::uint32_t> items,
                  const scenes::Bounds& box) {
    if (items.size() > kTileLanes) return false;
    begin(kind, blocks.size(), box);
    auto& block = blocks.emplace_back();
    for (const std::uint32_t item : items) add(block, item);
    return true;
  }

  bool pack_triangles(std::span<const std::uint32_t> items, const scenes::Bounds& box) {
    const scenes::Scene& scene = parts_->scene;
    auto& meshlets = made_.blocks.meshlets;
    Meshlet& meshlet = meshlets.emplace_back();
    auto& vertices = made_.blocks.meshlet_vertices;
    const OpenMeshlet open{meshlet, parts_->moves ? &vertices.emplace_back() : nullptr};
    for (const std::uint32_t item : items) {
      if (append(open, scene, scene.triangles[parts_->parts[item].index])) continue;
      meshlets.pop_back();
      if (parts_->moves) vertices.pop_back();
      return false;
    }
    const glm::vec3 sides = box.extent();
    meshlet.extent = std::max({sides.x, sides.y, sides.z});
    begin(TileChild::Kind::kMeshlet, meshlets.size() - 1, box);
    note_solids(items);
    return true;
  }

  /// Marks the triangles of the last meshlet that belong to solids.
  void note_solids(std::span<const std::uint32_t> items) {
    const Solids& solids = parts_->solids;
    if (solids.solids.empty()) return;
    Meshlet& meshlet = made_.blocks.meshlets.back();
    const auto number = static_cast<std::uint32_t>(made_.blocks.meshlets.size() - 1);
    for (std::size_t i = 0; i < items.size(); ++i) {
      const std::uint32_t solid = solids.of_triangle[parts_->parts[items[i]].index];
      if (solid == Solids::kNone) continue;
      const std::uint32_t bit = 1U << i;
      meshlet.solid |= bit;
      if (solids.solids[solid].inward) meshlet.clockwise |= bit;
      const SolidMeshlet is_in{solid, number};
      if (made_.solid_meshlets.empty() || made_.solid_meshlets.back() != is_in) {
        made_.solid_meshlets.push_back(is_in);
      }
    }
  }

  void add(SphereBlock& block, std::uint32_t item) {
    const scenes::Sphere& sphere = parts_->scene.spheres[parts_->parts[item].index];
    const std::size_t lane = block.count++;
    for (int axis = 0; axis < 3; ++axis) {
      block.center[static_cast<std::size_t>(axis)][lane] = sphere.center[axis];
    }
    block.radius[lane] = sphere.radius;
    block.primitives[lane] = parts_->parts[item].primitive;
    if (sphere.inside_only) block.inside_only |= 1U << lane;
  }

  void add(ConeBlock& block, std::uint32_t item) {
    const std::size_t lane = block.count++;
    block.boxes.set(lane, parts_->boxes[item]);
    block.primitives[lane] = parts_->parts[item].primitive;
  }

  const TileParts* parts_;
  std::vector<std::uint32_t> of_kind_;  ///< items of one kind in the current leaf; reused
  PackedLeaves made_;
};

/// Joins the packed parts in their order.
class Joining {
 public:
  Joining(const scenes::Scene& scene, std::vector<LeafPacker>& parts) : parts_(&parts) {
    for (LeafPacker& part : parts) {
      begins_.push_back(end_);
      const TileBlocks& blocks = part.made().blocks;
      end_.meshlets += blocks.meshlets.size();
      end_.spheres += blocks.spheres.size();
      end_.cones += blocks.cones.size();
      end_.packed += part.made().packed.size();
      end_.solid_meshlets += part.made().solid_meshlets.size();
      end_.leaves += part.made().first.size() - 1;
    }
    require_index(scene, std::max({end_.meshlets, end_.spheres, end_.cones}));
  }

  PackedLeaves operator()() {
    PackedLeaves whole;
    whole.blocks.meshlets.resize(end_.meshlets);
    if (!(*parts_)[0].made().blocks.meshlet_vertices.empty()) {
      whole.blocks.meshlet_vertices.resize(end_.meshlets);
    }
    whole.blocks.spheres.resize(end_.spheres);
    whole.blocks.cones.resize(end_.cones);
    whole.packed.resize(end_.packed);
    whole.solid_meshlets.resize(end_.solid_meshlets);
    whole.first.resize(end_.leaves + 1);
    whole.first.back() = static_cast<std::uint32_t>(end_.packed);
    tbb::parallel_for(std::size_t{0}, parts_->size(),
                      [&](std::size_t i) { copy((*parts_)[i].made(), begins_[i], whole); });
    return whole;
  }

 private:
  /// The beginning of a part in the whole.
  struct Begin {
    std::size_t meshlets = 0;
    std::size_t spheres = 0;
    std::size_t cones = 0;
    std::size_t packed = 0;
    std::size_t solid_meshlets = 0;
    std::size_t leaves = 0;

    std::size_t of(TileChild::Kind kind) const {
      if (kind == TileChild::Kind::kMeshlet) return meshlets;
      return kind == TileChild::Kind::kSpheres ? spheres : cones;
    }
  };

  static void copy(const PackedLeaves& part, const Begin& begin, PackedLeaves& whole) {
    const auto to = [](auto& all, std::size_t first) { return all.data() + first; };
    std::copy(part.blocks.meshlets.begin(), part.blocks.meshlets.end(),
              to(whole.blocks.meshlets, begin.meshlets));
    std::copy(part.blocks.meshlet_vertices.begin(), part.blocks.meshlet_vertices.end(),
              to(whole.blocks.meshlet_vertices, begin.meshlets));
    std::copy(part.blocks.spheres.begin(), part.blocks.spheres.end(),
              to(whole.blocks.spheres, begin.spheres));
    std::copy(part.blocks.cones.begin(), part.blocks.cones.end(),
              to(whole.blocks.cones, begin.cones));
    for (std::size_t i = 0; i < part.packed.size(); ++i) {
      const TileChild child = part.packed[i].child;
      const std::size_t index = child.index() + begin.of(child.kind());
      whole.packed[begin.packed + i] = {TileChild(child.kind(), static_cast<std::uint32_t>(index)),
                                        part.packed[i].box};
    }
    for (std::size_t i = 0; i < part.solid_meshlets.size(); ++i) {
      const auto [solid, meshlet] = part.solid_meshlets[i];
      whole.solid_meshlets[begin.solid_meshlets + i] = {
          solid, static_cast<std::uint32_t>(meshlet + begin.meshlets)};
    }
    for (std::size_t i = 0; i + 1 < part.first.size(); ++i) {
      whole.first[begin.leaves + i] = static_cast<std::uint32_t>(begin.packed + part.first[i]);
    }
  }

  std::vector<LeafPacker>* parts_;
  std::vector<Begin> begins_;
  Begin end_;
};

/// Leaves per task: enough that joining is comparatively cheap.
constexpr std::size_t kLeavesOfPart = 1024;

}  // namespace

PackedLeaves pack_leaves(const TileParts& parts,
                         std::span<const std::span<const std::uint32_t>> leaves, bool parallel) {
  const auto pack_range = [&](LeafPacker& packer, std::size_t begin, std::size_t end) {
    packer.reserve(end - begin);
    for (std::size_t leaf = begin; leaf < end; ++leaf) packer.pack(leaves[leaf]);
  };
  const std::size_t count = (leaves.size() + kLeavesOfPart - 1) / kLeavesOfPart;
  if (!parallel || count < 2) {
    LeafPacker packer(parts);
    pack_range(packer, 0, leaves.size());
    return std::move(packer.made());
  }
  std::vector<LeafPacker> packers(count, LeafPacker(parts));
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    pack_range(packers[i], i * kLeavesOfPart, std::min((i + 1) * kLeavesOfPart, leaves.size()));
  });
  return Joining(parts.scene, packers)();
}

}  // namespace beambench::accel::tile_beam
