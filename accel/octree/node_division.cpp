#include "accel/octree/node_division.hpp"

#include <algorithm>
#include <bit>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "accel/core/overlap.hpp"
#include "accel/core/tolerance.hpp"
#include "accel/octree/cost_planes.hpp"
#include "scenes/base/error.hpp"

namespace beambench::accel::octree {
namespace {

/// The number of cells along each axis for arbitrary planes, which are rounded to cells: the
/// maximum that a `CellRange` can number.
constexpr int kCostCells = 1 << 16;

}  // namespace

CellGrid octree_grid(const scenes::Scene& scene, const OctreeOptions& options) {
  const double tolerance = std::max(overlap_tolerance(scene), options.least_tolerance);
  glm::dvec3 size(0.0);
  if (!scene.bounds.empty()) size = glm::dvec3(scene.bounds.upper) - glm::dvec3(scene.bounds.lower);
  if (options.root == OctreeOptions::Root::kCube) {
    size = glm::dvec3(std::max({size.x, size.y, size.z}));
  }
  // Hits lie within the tolerance of the bounds, so the root must contain that margin.
  const glm::dvec3 margin = glm::max(size * options.pad, glm::dvec3(2.0 * tolerance));
  return make_cell_grid(
      scene.bounds, size, margin,
      glm::ivec3(options.planes == OctreeOptions::Planes::kCost ? kCostCells
                                                                : 1 << (options.max_level - 1)));
}

NodeDivision::NodeDivision(const scenes::Scene& scene, const OctreeOptions& options)
    : scene_(&scene),
      options_(&options),
      tolerance_(std::max(overlap_tolerance(scene), options.least_tolerance)),
      grid_(octree_grid(scene, options)) {
  const auto count = static_cast<scenes::PrimitiveId>(scene.primitives.size());
  ranges_.reserve(count);
  repeats_.reserve(count);
  for (scenes::PrimitiveId id = 0; id < count; ++id) {
    ranges_.push_back(cell_range(grid_, scenes::primitive_bounds(scene, id), tolerance_));
    repeats_.push_back(id > 0 && same_surface(scene, id - 1, id));
  }
}

glm::ivec3 NodeDivision::split(const OctreeCell& cell,
                               std::span<const scenes::PrimitiveId> primitives) const {
  if (options_->planes == OctreeOptions::Planes::kCost) {
    return cost_planes(grid_, cell.corner, cell.size, ranges_, primitives);
  }
  return cell.corner + cell.size / 2;
}

// Sorts by counting, which is stable and so keeps ids in increasing order.
std::array<std::size_t, 8> NodeDivision::distribute(const OctreeCell& cell, const glm::ivec3& split,
                                                    std::span<const scenes::PrimitiveId> primitives,
                                                    std::vector<std::uint8_t>& octants,
                                                    std::vector<scenes::PrimitiveId>& lists) const {
  octants.resize(primitives.size());
  std::array<std::size_t, 8> ends{};
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    const bool repeats = i > 0 && repeats_[primitives[i]] && primitives[i - 1] + 1 == primitives[i];
    octants[i] = repeats ? octants[i - 1] : overlapped_octants(cell, split, primitives[i]);
    for (std::uint32_t rest = octants[i]; rest != 0; rest &= rest - 1) {
      ++ends[static_cast<std::size_t>(std::countr_zero(rest))];
    }
  }
  std::array<std::size_t, 8> next{};
  for (std::size_t octant = 1; octant < 8; ++octant) {
    next[octant] = ends[octant - 1];
    ends[octant] += ends[octant - 1];
  }
  lists.resize(ends[7]);
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    for (std::uint32_t rest = octants[i]; rest != 0; rest &= rest - 1) {
      lists[next[static_cast<std::size_t>(std::countr_zero(rest))]++] = primitives[i];
    }
  }
  return ends;
}

std::vector<scenes::PrimitiveId> NodeDivision::all() const {
  std::vector<scenes::PrimitiveId> primitives(scene_->primitives.size());
  std::iota(primitives.begin(), primitives.end(), scenes::PrimitiveId{0});
  return primitives;
}

auto NodeDivision::estimate_of(std::vector<scenes::PrimitiveId> primitives, int level) const {
  struct Node {
    OctreeCell cell;
    std::vector<scenes::PrimitiveId> primitives;
    std::size_t size() const { return primitives.size(); }
  };
  auto divide = [this, level, lists = std::vector<scenes::PrimitiveId>(),
                 octants = std::vector<std::uint8_t>()](
                    const Node& node) mutable -> std::optional<std::vector<Node>> {
    if (node.cell.level >= level || !divides(node.cell, node.size())) return std::nullopt;
    const glm::ivec3 planes = split(node.cell, node.primitives);
    const auto ends = distribute(node.cell, planes, node.primitives, octants, lists);
    std::vector<Node> children;
    std::ptrdiff_t begin = 0;
    for (std::uint32_t octant = 0; octant < 8; ++octant) {
      const auto end = static_cast<std::ptrdiff_t>(ends[octant]);
      if (begin < end) {
        children.push_back(
            {node.cell.child(planes, octant), {lists.begin() + begin, lists.begin() + end}});
      }
      begin = end;
    }
    return children;
  };
  return ReferenceEstimate(Node{root(), std::move(primitives)}, std::move(divide));
}

ExpectedReferences NodeDivision::expected_references(int level, Random& random) const {
  return estimate_of(all(), level)(random);
}

namespace {

double chosen(const ExpectedReferences& expected, bool of_lists) {
  return of_lists ? expected.lists : expected.leaves;
}

}  // namespace

void NodeDivision::require_few_references(int level, bool of_lists) const {
  if (options_->planes != OctreeOptions::Planes::kMedian) return;
  const bool exceeds =
      part_surely_exceeds(options_->max_references, all(),
                          [&](std::vector<scenes::PrimitiveId> primitives, Random& random) {
                            auto estimate = estimate_of(std::move(primitives), level);
                            return chosen(estimate(random), of_lists);
                          });
  if (exceeds) fail_too_many_references();
}

bool NodeDivision::will_exceed(int level, bool of_lists) const {
  auto estimate = estimate_of(all(), level);
  return surely_more_than(options_->max_references,
                          [&](Random& random) { return chosen(estimate(random), of_lists); });
}

/// Returns the children that refer to a primitive of the node, as a bit mask.
std::uint8_t NodeDivision::overlapped_octants(const OctreeCell& cell, const glm::ivec3& split,
                                              scenes::PrimitiveId id) const {
  constexpr std::array<std::uint8_t, 3> kLowHalf{0x55, 0x33, 0x0F};  // octants with the axis' bit 0
  const CellRange& range = ranges_[id];
  std::uint8_t octants = 0xFF;
  int axes_crossed = 0;
  bool contained = true;
  for (int axis = 0; axis < 3; ++axis) {
    const auto slot = static_cast<std::size_t>(axis);
    const std::int32_t corner = cell.corner[axis];
    const bool low = range.first[slot] < split[axis];
    const bool high = range.last[slot] >= split[axis];
    contained =
        contained && range.first[slot] >= corner && range.last[slot] < corner + cell.size[axis];
    if (low && high) {
      ++axes_crossed;
    } else {
      octants &= low ? kLowHalf[slot] : static_cast<std::uint8_t>(~kLowHalf[slot]);
    }
  }
  // If only one octant remains, or if a connected surface inside the node crosses only one plane,
  // no test is needed.
  if (axes_crossed == 0 || (axes_crossed == 1 && contained)) return octants;
  if (options_->assign == OctreeOptions::Assign::kBounds) return octants;
  for (std::uint32_t octant = 0; octant < 8; ++octant) {
    if ((octants >> octant & 1U) == 0) continue;
    const OctreeCell child = cell.child(split, octant);
    if (!surface_overlaps(*scene_, id, grid_.box(child.corner, child.size), tolerance_)) {
      octants &= static_cast<std::uint8_t>(~(1U << octant));
    }
  }
  return octants;
}

void NodeDivision::fail_too_many_references() const {
  throw InputError(fmt::format(
      "the octree of max_level {} over '{}' ({} primitives) holds more than {} references; "
      "lower max_level, raise max_objects, or raise max_references (4 bytes each)",
      options_->max_level, scene_->name, scene_->primitives.size(), options_->max_references));
}

}  // namespace beambench::accel::octree
