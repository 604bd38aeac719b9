#include "accel/kd_tree/kd_tracer.hpp"

#include <memory>

#include <hwy/targets.h>

#include "accel/core/registry.hpp"

namespace beambench::accel::kd_tree {

const char* KdTracer::instruction_set() const { return hwy::TargetName(kernels_->target); }

Statistics KdTracer::statistics() const {
  Statistics statistics;
  statistics.nodes = 2 * tree_.leaves - 1;  // every interior node has two children
  statistics.leaves = tree_.leaves;
  statistics.empty_leaves = tree_.empty_leaves;
  statistics.references = tree_.references;
  statistics.depth = tree_.depth;
  statistics.bytes = sizeof(*this) + tree_.nodes.capacity() * sizeof(KdNode) +
                     tree_.blocks.capacity() * sizeof(bvh::PrimitiveBlock);
  statistics.instruction_set = instruction_set();
  statistics.more = {{"cost", tree_.cost}};
  tree_.visits.append_to(statistics);
  return statistics;
}

std::vector<Cell> KdTracer::occupied_cells() const {
  std::vector<Cell> cells;
  for_each_leaf(tree_, [&](const KdNode& leaf, const KdPlace& place) {
    if (leaf.block_count() == 0) return;
    const scenes::Bounds& cell = place.cell;
    cells.push_back({{glm::dvec3(cell.lower), glm::dvec3(cell.upper)}, place.level});
  });
  return cells;
}

void register_kd_tree(Registry& registry) {
  registry.add({"kd-tree",
                "a kd-tree by the surface area heuristic, built in O(n log n) with clipping (Wald "
                "and Havran 2006), traversed with a stack (Havran 2000); Kaplan's BSP (1985) with "
                "builder=median",
                Conformance::kBitExact, KdTreeOptions::parameters(),
                [](const scenes::Scene& scene, const Parameters& parameters, const Workload&) {
                  return std::make_unique<KdTracer>(scene, KdTreeOptions::from(parameters));
                }});
  registry.describe_counters(
      "kd-tree", {{"confirmed_tests",
                   "primitives that passed the SIMD float test, which only rejects, and that "
                   "the canonical test in double tested again"}});
}

}  // namespace beambench::accel::kd_tree
