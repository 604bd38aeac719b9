#pragma once
// The hierarchy traversed by SIMD: eight children per node, primitives in blocks of eight.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "accel/bvh/bvh_builder.hpp"
#include "accel/bvh/primitive_block.hpp"
#include "accel/bvh/primitive_part.hpp"
#include "accel/core/expected_visits.hpp"
#include "accel/core/large_pages.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::bvh {

/// A reference to a child: a node, or a leaf, which is a run of blocks.
class ChildReference {
 public:
  static constexpr std::uint32_t kMaxBlocks = 15;            ///< per leaf
  static constexpr std::uint32_t kBlockIndices = 1U << 27U;  ///< one more than the largest

  ChildReference() = default;
  static ChildReference node(std::uint32_t index) { return ChildReference(index); }
  static ChildReference leaf(std::uint32_t first_block, std::uint32_t block_count) {
    return ChildReference(kLeaf | block_count << 27U | first_block);
  }
  static ChildReference from_bits(std::uint32_t bits) { return ChildReference(bits); }

  bool is_leaf() const { return (bits_ & kLeaf) != 0; }
  std::uint32_t node_index() const { return bits_; }
  std::uint32_t first_block() const { return bits_ & (kBlockIndices - 1); }
  std::uint32_t block_count() const { return bits_ >> 27U & kMaxBlocks; }
  std::uint32_t bits() const { return bits_; }

 private:
  explicit ChildReference(std::uint32_t bits) : bits_(bits) {}

  static constexpr std::uint32_t kLeaf = 1U << 31U;
  std::uint32_t bits_ = 0;
};

/// The boxes of up to eight children; missing children have empty boxes and come last.
struct alignas(64) WideNode {
  std::array<std::array<float, kBvhLanes>, 6> planes;  ///< lower x, y, z; upper x, y, z
  std::array<ChildReference, kBvhLanes> children;
  /// For each octant of directions (bit a: backward along axis a), the lanes in order from the
  /// farthest child along the octant to the nearest, three bits each.
  std::array<std::uint32_t, 8> orders;

  std::uint32_t count() const {
    std::uint32_t present = 0;
    while (present < kBvhLanes && planes[0][present] <= planes[3][present]) ++present;
    return present;
  }
  scenes::Bounds box(std::size_t lane) const {
    return {{planes[0][lane], planes[1][lane], planes[2][lane]},
            {planes[3][lane], planes[4][lane], planes[5][lane]}};
  }
  void set_box(std::size_t lane, const scenes::Bounds& box) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto row = static_cast<std::size_t>(axis);
      planes[row][lane] = box.lower[axis];
      planes[row + 3][lane] = box.upper[axis];
    }
  }
  /// Returns the box of all children.
  scenes::Bounds bounds() const {
    scenes::Bounds bounds;
    for (std::size_t lane = 0; lane < count(); ++lane) bounds.include(box(lane));
    return bounds;
  }
};
static_assert(sizeof(WideNode) == 256);

/// A hierarchy over a scene's triangles, spheres and cones. A polygon's triangles are separate:
/// the nearest of them is the polygon's hit. Boxes are widened by `overlap_tolerance`.
struct WideBvh {
  LargePageVector<WideNode> nodes;
  LargePageVector<PrimitiveBlock> blocks;
  ChildReference root;
  scenes::Bounds scene_bounds;
  std::uint32_t depth = 0;  ///< nodes on the longest path to a leaf, including the leaf
  std::uint64_t leaves = 0;
  std::uint64_t references = 0;  ///< references to triangles, spheres and cones
  ExpectedVisits visits;
  double cost = 0.0;      ///< `sah_cost` of the binary hierarchy it was made from
  bool is_refit = false;  ///< `visits` and `cost` are those of the original boxes

  bool empty() const { return blocks.empty(); }
};

enum class BvhBuilder : std::uint8_t {
  kLbvh,    ///< `build_lbvh`
  kPloc,    ///< `build_ploc`
  kBinned,  ///< `build_bvh`
  kSweep,   ///< `build_sweep_bvh`
  kSpatial  ///< `build_spatial_bvh`: unlike the others, may divide pieces among leaves
};

enum class BvhCollapse : std::uint8_t {
  kArea,  ///< `gather_children`: replaces the child with the largest area by its children
  kCost   ///< `Collapse`: the lowest cost for streams
};

struct WideBvhOptions {
  BvhOptions splits;
  BvhBuilder builder = BvhBuilder::kBinned;
  BvhCollapse collapse = BvhCollapse::kArea;
  bool reinsertion = false;  ///< apply `reinsert` to the builder's result
};

/// Throws InputError if the scene needs more than ChildReference::kBlockIndices blocks.
WideBvh build_wide_bvh(const scenes::Scene& scene, const WideBvhOptions& options);

/// Makes a wide hierarchy for streams from a binary one that another structure built over a scene's
/// parts (`collect_parts`) and their boxes. The binary hierarchy's leaves are divided, and
/// `Collapse` chooses nodes and leaves. Throws like build_wide_bvh.
WideBvh widen_for_streams(const scenes::Scene& scene, std::vector<PrimitivePart> parts,
                          std::span<const scenes::Bounds> boxes, BinaryBvh binary, bool parallel);

}  // namespace beambench::accel::bvh
