#include "harness/measure/open_view.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "harness/measure/record/block_statistics.hpp"

namespace beambench::measure {
namespace {

/// The minimum spread assumed for blocks, whatever the spread of one block's repetitions: some
/// processes are faster than others.
constexpr double kMinSpread = 0.01;

/// Returns the time needed for the remaining blocks.
double expected_ms(const std::vector<OpenView>& views, const BlockLimits& limits) {
  double sum = 0.0;
  for (const OpenView& open : views) {
    sum += open.block_ms * std::max(open.blocks - blocks_done(open, limits), 0);
  }
  return sum;
}

}  // namespace

BlockLimits::BlockLimits(const SweepConfig& config)
    : repetitions_allowed(config.maximum_repetitions) {
  constexpr int kMinEach = 3;
  const int blocks = std::max(repetitions_allowed / kMinEach, 1);
  each = repetitions_allowed < kMinEach * kMinEach ? (repetitions_allowed + blocks - 1) / blocks
                                                   : kMinEach;
  maximum = (repetitions_allowed + each - 1) / each;
  minimum = std::min((config.minimum_repetitions + each - 1) / each, maximum);
}

int BlockLimits::repetitions(int blocks) const {
  return std::min(blocks * each, repetitions_allowed);
}

int turns(const CellRecord& cell, std::optional<int> block) {
  std::set<std::pair<int, int>> made;
  for (const Repetition& one : cell.repetitions) {
    if (!block || one.block == *block) made.emplace(one.block, one.round);
  }
  return static_cast<int>(made.size());
}

int next_round(const OpenView& open) {
  int next = 0;
  for (const OpenCell& cell : open.cells) {
    for (const Repetition& one : cell.record.repetitions) next = std::max(next, one.round + 1);
  }
  return next;
}

int lacking(const OpenView& open, const OpenCell& cell, int block, const BlockLimits& limits) {
  if (cell.record.is_finished) return 0;
  return std::max(std::min(limits.each - turns(cell.record, block),
                           limits.repetitions(open.blocks) - turns(cell.record)),
                  0);
}

std::vector<BlockCell> due(const OpenView& open, int block, const BlockLimits& limits) {
  std::vector<BlockCell> cells;
  for (const OpenCell& cell : open.cells) {
    const int left = lacking(open, cell, block, limits);
    if (left > 0) cells.push_back({cell.planned, cell.record, left});
  }
  return cells;
}

int blocks_done(const OpenView& open, const BlockLimits& limits) {
  int fewest = limits.maximum;
  for (const OpenCell& cell : open.cells) {
    fewest = std::min(fewest, turns(cell.record) / limits.each);
  }
  return fewest;
}

void plan_blocks(std::vector<OpenView>& views, const BlockLimits& limits, const SweepConfig& config,
                 double left_ms) {
  const int fewest = std::max(limits.minimum, std::min(config.blocks, limits.maximum));
  for (OpenView& open : views) {
    double spread = kMinSpread;
    for (const OpenCell& cell : open.cells) spread = std::max(spread, spread_of(cell.record));
    const int needed = blocks_for_precision(spread, config.precision, limits.maximum);
    open.blocks = std::clamp(needed, fewest, limits.maximum);
    open.reason = open.blocks == limits.maximum && needed >= limits.maximum
                      ? StopReason::kRepetitions
                      : StopReason::kPrecision;
  }
  // The views with the most blocks are reduced first.
  while (expected_ms(views, limits) > left_ms) {
    const auto most = std::ranges::max_element(views, {}, &OpenView::blocks);
    if (most == views.end() || most->blocks <= limits.minimum) break;
    const int top = most->blocks;
    for (OpenView& open : views) {
      if (open.blocks < top || open.blocks <= limits.minimum) continue;
      --open.blocks;
      open.reason = StopReason::kBudget;
    }
  }
}

}  // namespace beambench::measure
