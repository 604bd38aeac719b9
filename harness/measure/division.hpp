#pragma once
// How a sweep is divided into shards.

#include <vector>

#include "harness/measure/config.hpp"
#include "harness/measure/plan.hpp"
#include "harness/measure/record/manifest.hpp"
#include "harness/measure/record/shard.hpp"

namespace beambench::measure {

/// A shard, and the whole sweep that it is a part of.
struct PlannedShard {
  ShardFacts facts;
  std::vector<SceneFacts> scenes;  ///< of the whole sweep
  double share;                    ///< of the estimated work of the whole sweep, from 0 to 1
};

/// Leaves in `plan`, which is that of the whole sweep, the cells of one shard. A group, whose cells
/// are compared, goes to one shard as a whole. The groups are handed out by their estimated cost,
/// the most expensive first, each to the shard that has the least so far, so that every process
/// finds the same division by itself. Cells keep their place in the whole plan. Throws InputError
/// where there are fewer groups than shards.
PlannedShard keep_shard(Plan& plan, const SweepConfig& config, const Shard& shard);

}  // namespace beambench::measure
