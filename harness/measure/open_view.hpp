#pragma once
// A view while it is measured: the blocks that it has, and those that it needs.

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
  double block_ms = 0.0;  ///< of the first block, with the start of its process
  int blocks = 1;         ///< planned; before that, as many as are allowed
  StopReason reason = StopReason::kRepetitions;  ///< why there are no more
};

/// How a sweep's repetitions are divided into blocks.
struct BlockLimits {
  int each;     ///< repetitions of a cell in a block: three, or four and five where few are made
  int minimum;  ///< blocks that are made even when the time is up
  int maximum;
  int repetitions_allowed;

  explicit BlockLimits(const SweepConfig& config);

  /// Returns the repetitions of a cell in that many blocks.
  int repetitions(int blocks) const;
};

/// Returns how often a contender had its turn, in a block or in all: a repetition that was
/// disturbed and the one that replaces it are one turn.
int turns(const CellRecord& cell, std::optional<int> block = std::nullopt);

/// Returns the first round without a repetition of any contender of a view.
int next_round(const OpenView& open);

/// Returns the number of repetitions that a cell lacks in a block; 0 where it is finished.
int lacking(const OpenView& open, const OpenCell& cell, int block, const BlockLimits& limits);

/// Returns what is left of a block: the cells that lack repetitions.
std::vector<BlockCell> due(const OpenView& open, int block, const BlockLimits& limits);

/// Returns the number of whole blocks that all cells of a view have.
int blocks_done(const OpenView& open, const BlockLimits& limits);

/// Fixes the number of blocks of each view after its first one: at least those of the sweep, as
/// many as the precision needs, but no more than `left_ms` allows.
void plan_blocks(std::vector<OpenView>& views, const BlockLimits& limits, const SweepConfig& config,
                 double left_ms);

}  // namespace beambench::measure
