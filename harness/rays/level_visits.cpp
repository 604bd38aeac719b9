#include "harness/rays/level_visits.hpp"

#include <bit>
#include <limits>

#include "accel/beam/beam_tracer.hpp"
#include "accel/octree/samet.hpp"

namespace beambench::rays {
namespace {

const accel::octree::Octree* octree_of(const accel::Accelerator& structure) {
  if (const auto* samet = dynamic_cast<const accel::octree::Samet*>(&structure))
    return &samet->octree();
  if (const auto* net = dynamic_cast<const accel::octree::SametNet*>(&structure))
    return &net->octree();
  return nullptr;
}

/// The level of each node. A parent stands before its children.
std::vector<int> levels_of(const accel::octree::Octree& octree) {
  std::vector<int> levels(octree.nodes().size(), 1);
  for (std::size_t i = 1; i < levels.size(); ++i) {
    levels[i] = levels[octree.nodes()[i].parent] + 1;
  }
  return levels;
}

/// Counts each beam at the level of the leaf that it enters.
class BeamsByLevel : public accel::beam::NoBeamWatch {
 public:
  BeamsByLevel(const std::vector<int>& levels, std::vector<LevelVisits>& visits)
      : levels_(&levels), visits_(&visits) {}

  void met(accel::BeamKind kind, const accel::beam::Beam& beam) {
    if (kind == accel::BeamKind::kLeaving) return;  // it is in no leaf anymore
    ++(*visits_)[static_cast<std::size_t>((*levels_)[beam.node] - 1)].beams;
  }

 private:
  const std::vector<int>* levels_;
  std::vector<LevelVisits>* visits_;
};

}  // namespace

std::vector<LevelVisits> count_level_visits(const accel::Accelerator& structure,
                                            const TraceInput& input) {
  const accel::octree::Octree* octree = octree_of(structure);
  if (octree == nullptr) return {};
  const std::span<const accel::octree::OctreeNode> nodes = octree->nodes();
  const std::vector<int> levels = levels_of(*octree);

  std::vector<LevelVisits> visits;
  const auto at = [&](std::size_t node) -> LevelVisits& {
    return visits[static_cast<std::size_t>(levels[node] - 1)];
  };
  for (std::size_t node = 0; node < nodes.size(); ++node) {
    while (visits.size() < static_cast<std::size_t>(levels[node])) {
      visits.push_back({.level = static_cast<int>(visits.size()) + 1});
    }
    ++at(node).nodes;
    if (!nodes[node].is_leaf()) continue;
    ++at(node).leaves;
    at(node).occupied_leaves += nodes[node].count > 0 ? 1 : 0;
  }

  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> last_ray(nodes.size(), kNone);
  for (std::size_t ray = 0; ray < input.size(); ++ray) {
    for (const accel::TraceStep& step : structure.explain(input.ray(ray))) {
      ++at(step.index).leaf_visits;
      for (std::size_t node = step.index; last_ray[node] != ray; node = nodes[node].parent) {
        last_ray[node] = ray;
        ++at(node).node_visits;
      }
    }
  }

  const auto* beams = dynamic_cast<const accel::beam::BeamTracer*>(&structure);
  if (beams != nullptr && input.image() != nullptr) {
    const accel::PrimaryRays& image = *input.image();
    accel::HitBuffer buffer(image.width(), image.height(), image.samples());
    BeamsByLevel watch(levels, visits);
    beams->trace_watched(image, buffer, watch);
  }
  return visits;
}

}  // namespace beambench::rays
