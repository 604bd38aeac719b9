#include "accel/octree/on_demand_octree.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace beambench::accel::octree {

OnDemandOctree::OnDemandOctree(const scenes::Scene& scene, const OctreeOptions& options)
    : options_(options), division_(scene, options_), limit_(options_.max_references, scene, [this] {
        return division_.will_exceed(options_.built_level, true);
      }) {
  division_.require_few_references(options_.built_level, true);
  root_.references.resize(scene.primitives.size());
  std::iota(root_.references.begin(), root_.references.end(), scenes::PrimitiveId{0});
  divide_to(root_, root_cell(), options_.built_level);
  // From now on, the rays determine which nodes are divided.
  limit_ = ReferenceLimit(options_.max_references);
}

void OnDemandOctree::divide_to(const OnDemandNode& node, const OctreeCell& cell, int level) const {
  if (cell.level >= level) return;
  const Children* below = children(node, cell);
  if (below == nullptr) return;
  for (std::uint32_t octant = 0; octant < 8; ++octant) {
    divide_to(below->nodes[octant], cell.child(below->split, octant), level);
  }
}

const Children& OnDemandOctree::divide(const OnDemandNode& node, const OctreeCell& cell) const {
  auto made = std::make_unique<Children>();
  made->split = division_.split(cell, node.references);
  std::vector<std::uint8_t> octants;
  std::vector<scenes::PrimitiveId> lists;
  const auto ends = division_.distribute(cell, made->split, node.references, octants, lists);
  for (std::size_t octant = 0; octant < 8; ++octant) {
    const auto begin =
        lists.begin() + static_cast<std::ptrdiff_t>(octant == 0 ? 0 : ends[octant - 1]);
    made->nodes[octant].references.assign(
        begin, lists.begin() + static_cast<std::ptrdiff_t>(ends[octant]));
  }
  const std::lock_guard lock(publishing_);
  if (const Children* earlier = node.children.load(std::memory_order_acquire)) return *earlier;
  if (limit_.exceeded(references_made_ + lists.size())) {
    division_.fail_too_many_references();
  }
  references_made_ += lists.size();
  const Children& published = *divided_.emplace_back(std::move(made));
  node.children.store(&published, std::memory_order_release);
  return published;
}

template <class Visit>
void OnDemandOctree::for_each_node(Visit visit) const {
  std::vector<std::pair<const OnDemandNode*, OctreeCell>> open{{&root_, root_cell()}};
  while (!open.empty()) {
    const auto [node, cell] = open.back();
    open.pop_back();
    const Children* below = node->children.load(std::memory_order_acquire);
    visit(*node, cell, below == nullptr);
    if (below == nullptr) continue;
    for (std::uint32_t octant = 0; octant < 8; ++octant) {
      open.emplace_back(&below->nodes[octant], cell.child(below->split, octant));
    }
  }
}

Statistics OnDemandOctree::statistics() const {
  Statistics statistics;
  std::uint64_t undivided = 0;
  statistics.bytes = sizeof(*this);
  for_each_node([&](const OnDemandNode& node, const OctreeCell& cell, bool leaf) {
    ++statistics.nodes;
    statistics.bytes += node.references.capacity() * sizeof(scenes::PrimitiveId);
    if (!leaf) {
      statistics.bytes += sizeof(Children) + sizeof(std::unique_ptr<const Children>);
      return;
    }
    ++statistics.leaves;
    statistics.depth = std::max(statistics.depth, static_cast<std::uint64_t>(cell.level));
    statistics.references += node.references.size();
    if (node.references.empty()) ++statistics.empty_leaves;
    if (division_.divides(cell, node.references.size())) ++undivided;
  });
  statistics.more.emplace_back("undivided_nodes", static_cast<double>(undivided));
  return statistics;
}

std::vector<Cell> OnDemandOctree::occupied_cells() const {
  std::vector<Cell> cells;
  for_each_node([&](const OnDemandNode& node, const OctreeCell& cell, bool leaf) {
    if (!leaf || node.references.empty()) return;
    cells.push_back({grid().box(cell.corner, cell.size), cell.level});
  });
  return cells;
}

}  // namespace beambench::accel::octree
