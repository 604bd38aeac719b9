#include "harness/measure/division.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "harness/base/messages.hpp"
#include "harness/measure/cost.hpp"
#include "scenes/base/error.hpp"

namespace beambench::measure {
namespace {

std::vector<double> costs_of(const Plan& plan, const SweepConfig& config) {
  const double allowance_ns = 1e9 * config.budget_seconds /
                              static_cast<double>(std::max<std::size_t>(plan.cell_count(), 1));
  std::vector<double> costs;
  costs.reserve(plan.groups.size());
  for (const CellGroup& group : plan.groups) {
    costs.push_back(estimated_ns(group, config, allowance_ns));
  }
  return costs;
}

/// Returns the shard of each group, numbered from 0.
std::vector<std::size_t> shards_of(const std::vector<double>& costs, std::size_t count) {
  std::vector<std::size_t> order(costs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order,
                           [&](std::size_t a, std::size_t b) { return costs[a] > costs[b]; });
  std::vector<double> loads(count, 0.0);
  std::vector<std::size_t> shards(costs.size());
  for (const std::size_t group : order) {
    const auto least = std::ranges::min_element(loads);  // the first of equals
    *least += costs[group];
    shards[group] = static_cast<std::size_t>(least - loads.begin());
  }
  return shards;
}

}  // namespace

PlannedShard keep_shard(Plan& plan, const SweepConfig& config, const Shard& shard) {
  const auto count = static_cast<std::size_t>(shard.count);
  if (count > plan.groups.size()) {
    throw InputError(fmt::format(
        "--shard {}: the sweep has {} (of one scene, camera, resolution, number of samples and "
        "kind of rays each), whose cells are compared and stay together; divide it into at most {}",
        to_string(shard), base::counted(plan.groups.size(), "group"), plan.groups.size()));
  }
  PlannedShard planned{{shard, 0, plan.cell_count()}, scene_facts(plan), 0.0};
  const std::vector<double> costs = costs_of(plan, config);
  const std::vector<std::size_t> shards = shards_of(costs, count);
  double own = 0.0;
  std::vector<CellGroup> kept;
  for (std::size_t i = 0; i < plan.groups.size(); ++i) {
    if (shards[i] + 1 != static_cast<std::size_t>(shard.number)) continue;
    own += costs[i];
    kept.push_back(std::move(plan.groups[i]));
  }
  plan.groups = std::move(kept);
  planned.facts.cells = plan.cell_count();
  planned.share = own / std::accumulate(costs.begin(), costs.end(), 0.0);
  return planned;
}

}  // namespace beambench::measure
