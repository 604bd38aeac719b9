#pragma once
// Divides a sweep into shards.

#include <vector>

#include "harness/measure/config.hpp"
#include "harness/measure/plan.hpp"
#include "harness/measure/record/manifest.hpp"
#include "harness/measure/record/shard.hpp"

namespace beambench::measure {

/// A shard, and facts about the whole sweep.
struct PlannedShard {
  ShardFacts facts;
  std::vector<SceneFacts> scenes;  ///< scenes of the whole sweep
  double share;                    ///< share of the estimated work of the whole sweep, from 0 to 1
};

/// Reduces `plan`, the plan of the whole sweep, to the cells of one shard. A group, whose cells are
/// compared, stays in one shard. The groups are assigned in order of estimated cost, the most
/// expensive first, each to the shard with the least cost so far, so every process computes the
/// same division. Cells keep their place in the whole plan. Throws InputError if there are fewer
/// groups than shards.
PlannedShard keep_shard(Plan& plan, const SweepConfig& config, const Shard& shard);

}  // namespace beambench::measure
