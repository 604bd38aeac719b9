#pragma once
// A view while it is measured: its finished blocks, and the number that it needs.

#include <optional>
#include <vector>

#include "harness/measure/block.hpp"
#include "harness/measure/config.hpp"
#include "harness/measure/plan.hpp"
#include "harness/measure/record/cell_record.hpp"

namespace beambench::measure {

/// A cell while it is measured.
struct OpenCell {
  PlannedCell planned;
  CellRecord record;
};

/// A view while it is measured.
struct OpenView {
  CellGroup view;  ///< without its cells
  std::vector<OpenCell> cells;
  int blocks_made = 0;
  double block_ms = 0.0;  ///< time of the first block, including the start of its process
  int blocks = 1;         ///< planned number; before planning, the maximum allowed
  StopReason reason = StopReason::kRepetitions;  ///< why there are no more blocks
};

/// How a sweep's repetitions are divided into blocks.
struct BlockLimits {
  int each;     ///< repetitions of a cell in a block: 3, or 4 to 5 where few are made
  int minimum;  ///< number of blocks made even when the time is up
  int maximum;
  int repetitions_allowed;

  explicit BlockLimits(const SweepConfig& config);

  /// Returns a cell's total number of repetitions in that many blocks.
  int repetitions(int blocks) const;
};

/// Returns how many turns a contender had, in a block or in total. A disturbed repetition and the
/// one that replaces it count as one turn.
int turns(const CellRecord& cell, std::optional<int> block = std::nullopt);

/// Returns the first round in which no contender of a view has a repetition.
int next_round(const OpenView& open);

/// Returns the number of repetitions that a cell still needs in a block; 0 if it is finished.
int lacking(const OpenView& open, const OpenCell& cell, int block, const BlockLimits& limits);

/// Returns the remainder of a block: the cells that still need repetitions.
std::vector<BlockCell> due(const OpenView& open, int block, const BlockLimits& limits);

/// Returns the number of blocks that are complete for all cells of a view.
int blocks_done(const OpenView& open, const BlockLimits& limits);

/// Determines the number of blocks of each view after its first block: at least the sweep's number,
/// and as many as the precision needs, but no more than fit into `left_ms`.
void plan_blocks(std::vector<OpenView>& views, const BlockLimits& limits, const SweepConfig& config,
                 double left_ms);

}  // namespace beambench::measure
