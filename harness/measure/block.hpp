#pragma once
// A block is the unit of measurement: one process builds and traces the contenders of a view a few
// times, in turns. Conditions that vary between processes (addresses, pages, caches) are the same
// for all these contenders, so times are compared within a block, and then across blocks (Kalibera
// and Jones, Rigorous benchmarking in reasonable time, ISMM 2013).

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "harness/measure/google_benchmark.hpp"
#include "harness/measure/plan.hpp"
#include "harness/measure/record/cell_events.hpp"

namespace beambench::measure {

/// A cell's part of a block.
struct BlockCell {
  PlannedCell cell;
  /// The results of earlier blocks; empty for a cell still to be counted and verified. Of its
  /// repetitions, only the number matters.
  CellRecord earlier;
  int repetitions;  ///< number to make in this block
};

/// A block to be measured.
struct Block {
  CellGroup view;  ///< without its cells
  std::vector<BlockCell> cells;
  int number;          ///< among the view's blocks, from 0
  int first_round;     ///< its first round; rounds are numbered across the view's blocks
  int second_traces;   ///< number of each cell's first repetitions that have a second trace
  int tries;           ///< maximum number of tries of a disturbed repetition
  int core;            ///< the core to pin to; -1: any
  bool tunes = false;  ///< whether its cells are candidates to be timed once (tuning.hpp)
};

/// The callbacks called while a block is measured.
struct BlockWatch {
  /// Receives the events of the cells and warnings.
  EventSink sink;
  /// Called before rays are generated, and before each counting pass and each repetition, with the
  /// cell's index in the plan (nothing for rays). An exception ends the block.
  std::function<void(std::optional<std::size_t> cell)> before_each_piece = [](auto) {};
};

/// Measures a block in this process. In each round every contender has one turn, in a newly
/// shuffled order; a disturbed repetition (`Repetition::is_undisturbed`) is repeated. An error of a
/// structure is reported as the end of its cell and never thrown.
void measure_block(const Block& block, const GoogleBenchmark& benchmark, const BlockWatch& watch);

}  // namespace beambench::measure
