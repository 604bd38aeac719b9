#pragma once
// A block, the unit of measurement: the contenders of a view, built and traced a few times in turns
// by one process. What differs from process to process (addresses, pages, caches) is the same for
// all of them, so that their times are compared within blocks, and the blocks with each other
// (Kalibera and Jones, Rigorous benchmarking in reasonable time, ISMM 2013).

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "harness/measure/google_benchmark.hpp"
#include "harness/measure/plan.hpp"
#include "harness/measure/record/cell_events.hpp"

namespace beambench::measure {

/// A cell's part in a block.
struct BlockCell {
  PlannedCell cell;
  /// The findings of earlier blocks: empty for a cell to be counted and verified. Of its
  /// repetitions only their number matters.
  CellRecord earlier;
  int repetitions;  ///< to make in this block
};

/// A block to be measured.
struct Block {
  CellGroup view;  ///< without its cells
  std::vector<BlockCell> cells;
  int number;          ///< of the view's blocks, from 0
  int first_round;     ///< of its repetitions: rounds are counted over all blocks of a view
  int second_traces;   ///< of each cell: so many of its first repetitions are followed by one
  int tries;           ///< of a repetition that other processes disturb, at most
  int core;            ///< to pin to; -1: any
  bool tunes = false;  ///< its cells are candidates to be timed once (tuning.hpp)
};

/// The receivers of reports while a block is measured.
struct BlockWatch {
  /// Receives the events of the cells and warnings.
  EventSink sink;
  /// Called before the rays are made, each counting pass and each repetition, with the cell's index
  /// in the plan (nothing while rays are made). An exception ends the block.
  std::function<void(std::optional<std::size_t> cell)> before_each_piece = [](auto) {};
};

/// Measures a block in this process. In each round every contender has a turn, in an order that is
/// shuffled anew; a disturbed repetition (`Repetition::is_undisturbed`) is made again. A
/// structure's fault is reported as the end of its cell and never thrown.
void measure_block(const Block& block, const GoogleBenchmark& benchmark, const BlockWatch& watch);

}  // namespace beambench::measure
