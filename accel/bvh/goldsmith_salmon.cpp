#include "accel/bvh/goldsmith_salmon.hpp"

#include <algorithm>
#include <numeric>

#include "accel/bvh/refit.hpp"
#include "accel/core/expected_visits.hpp"
#include "accel/core/padded_bounds.hpp"
#include "accel/core/registry.hpp"
#include "scenes/base/random.hpp"

namespace beambench::accel::bvh {
namespace {

void shuffle(std::vector<scenes::PrimitiveId>& ids, std::uint64_t seed) {
  Random random(seed);
  for (std::size_t left = ids.size(); left > 1; --left) {
    std::swap(ids[left - 1], ids[random.below(left)]);
  }
}

void sort_along_longest_axis(std::vector<scenes::PrimitiveId>& ids, const scenes::Scene& scene,
                             const std::vector<scenes::Bounds>& boxes) {
  const glm::vec3 extent = scene.bounds.extent();
  int axis = extent.x >= extent.y ? 0 : 1;
  if (extent.z > extent[axis]) axis = 2;
  std::stable_sort(ids.begin(), ids.end(), [&](scenes::PrimitiveId a, scenes::PrimitiveId b) {
    return boxes[a].lower[axis] + boxes[a].upper[axis] <
           boxes[b].lower[axis] + boxes[b].upper[axis];
  });
}

InsertionHierarchy build(const scenes::Scene& scene, const GoldsmithSalmonOptions& options) {
  const std::vector<scenes::Bounds> boxes = padded_primitive_bounds(scene);
  std::vector<scenes::PrimitiveId> order(boxes.size());
  std::iota(order.begin(), order.end(), scenes::PrimitiveId{0});
  if (options.order == GoldsmithSalmonOptions::Order::kShuffled) shuffle(order, options.seed);
  if (options.order == GoldsmithSalmonOptions::Order::kSorted) {
    sort_along_longest_axis(order, scene, boxes);
  }
  return build_by_insertion(boxes, order, options.insertion);
}

}  // namespace

std::vector<ParameterInfo> GoldsmithSalmonOptions::parameters() {
  return {
      choice_parameter("order", "given", {"given", "shuffled", "sorted"},
                       "insertion order: the scene's, at random, or by center along the "
                       "scene's longest axis"),
      integer_parameter("seed", 1, 0, 1'000'000'000, "seed of order=shuffled"),
      choice_parameter("queue", "heap", {"heap", "stack"},
                       "order of traversal for the closest hit: Kay and Kajiya's priority queue by "
                       "distance, or a stack with each volume's children in order"),
      choice_parameter("insert", "everywhere", {"everywhere", "terminal"},
                       "where on its path down an object may be placed: wherever it costs least "
                       "(Goldsmith and Salmon 1987), or only beside the terminal node at the "
                       "end (thesis, section 4.3)"),
      update_parameter()};
}

GoldsmithSalmonOptions GoldsmithSalmonOptions::from(const Parameters& parameters) {
  GoldsmithSalmonOptions options;
  const std::string& order = parameters.choice("order");
  if (order == "shuffled") options.order = Order::kShuffled;
  if (order == "sorted") options.order = Order::kSorted;
  options.seed = static_cast<std::uint64_t>(parameters.integer("seed"));
  if (parameters.choice("queue") == "stack") options.queue = Queue::kStack;
  if (parameters.choice("insert") == "terminal") options.insertion = Insertion::kTerminal;
  return options;
}

GoldsmithSalmon::GoldsmithSalmon(const scenes::Scene& scene, const GoldsmithSalmonOptions& options)
    : scene_(&scene), queue_(options.queue), hierarchy_(build(scene, options)) {}

bool GoldsmithSalmon::update(const scenes::Scene& scene) {
  scene_ = &scene;
  refit(hierarchy_, scene);
  return true;
}

Statistics GoldsmithSalmon::statistics() const {
  Statistics statistics;  // no leaves: volumes at every level have objects
  statistics.nodes = hierarchy_.volumes;
  statistics.references = hierarchy_.entries.size() - hierarchy_.volumes;
  statistics.depth = hierarchy_.depth;
  statistics.bytes = hierarchy_.entries.capacity() * sizeof(HierarchyEntry);
  statistics.more = {{"cost", hierarchy_.cost}, {"widest", static_cast<double>(hierarchy_.widest)}};
  ExpectedVisits visits(scene_->bounds);
  for (const HierarchyEntry& entry : hierarchy_.entries) {
    if (entry.is_volume()) {
      visits.add_node(entry.box);
    } else {
      visits.add_leaf(entry.box, 1);
    }
  }
  visits.append_to(statistics);
  return statistics;
}

void GoldsmithSalmon::describe(TreeQuality& tree) const {
  std::vector<std::uint32_t> ends;  // ends of the open volumes
  for (std::uint32_t i = 0; i < hierarchy_.entries.size(); ++i) {
    for (; !ends.empty() && ends.back() == i; ends.pop_back()) tree.close();
    const HierarchyEntry& entry = hierarchy_.entries[i];
    tree.open(entry.box);
    if (!entry.is_volume()) tree.add_primitive(entry.primitive);
    ends.push_back(entry.end);
  }
  for (; !ends.empty(); ends.pop_back()) tree.close();
}

}  // namespace beambench::accel::bvh
