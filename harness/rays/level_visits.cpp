#include "harness/rays/level_visits.hpp"

#include <limits>
#include <optional>
#include <span>

#include "accel/core/inspector_of.hpp"

namespace beambench::rays {
namespace {

/// Returns the level of each node. Parents precede their children.
std::vector<int> levels_of(std::span<const accel::NodeFacts> nodes) {
  std::vector<int> levels(nodes.size(), 1);
  for (std::size_t i = 1; i < levels.size(); ++i) levels[i] = levels[nodes[i].parent] + 1;
  return levels;
}

}  // namespace

std::vector<LevelVisits> count_level_visits(const accel::Accelerator& structure,
                                            const TraceInput& input) {
  const accel::Inspector& inspector = accel::inspector_of(structure);
  const std::vector<accel::NodeFacts> nodes = inspector.nodes();
  const std::vector<int> levels = levels_of(nodes);

  std::vector<LevelVisits> visits;
  const auto at = [&](std::size_t node) -> LevelVisits& {
    return visits[static_cast<std::size_t>(levels[node] - 1)];
  };
  for (std::size_t node = 0; node < nodes.size(); ++node) {
    while (visits.size() < static_cast<std::size_t>(levels[node])) {
      visits.push_back({.level = static_cast<int>(visits.size()) + 1});
    }
    ++at(node).nodes;
    if (!nodes[node].is_leaf) continue;
    ++at(node).leaves;
    at(node).occupied_leaves += nodes[node].references > 0 ? 1 : 0;
  }

  if (nodes.empty()) return {};

  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> last_ray(nodes.size(), kNone);
  for (std::size_t ray = 0; ray < input.size(); ++ray) {
    for (const accel::TraceStep& step : inspector.path(input.ray(ray))) {
      ++at(step.index).leaf_visits;
      for (std::size_t node = step.index; last_ray[node] != ray; node = nodes[node].parent) {
        last_ray[node] = ray;
        ++at(node).node_visits;
      }
    }
  }

  if (input.image() == nullptr) return visits;
  const auto beams = inspector.beams(*input.image());
  for (const accel::BeamOutline& beam : beams.value_or(std::vector<accel::BeamOutline>())) {
    if (beam.kind != accel::BeamKind::kLeaving) ++at(beam.node).beams;  // such a beam is in no leaf
  }
  return visits;
}

}  // namespace beambench::rays
