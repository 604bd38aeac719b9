#pragma once
// Measures blocks in processes of their own: this program again, with a command of its own. It
// reads a block from its standard input and writes events to its standard output, a line of JSON
// each.

#include <optional>
#include <string>
#include <vector>

#include "harness/measure/block.hpp"
#include "harness/plugin/activity.hpp"

namespace beambench::measure {

/// The command that a program has for blocks (`serve_block`); users do not call it.
inline constexpr const char* kBlockCommand = "measure-block";

/// The end of a process before its block was measured.
struct BrokenBlock {
  std::optional<std::size_t> cell;  ///< that it was measuring, by its index in the plan
  std::string how;                  ///< a clause: "it crashed (SIGSEGV: Segmentation fault)"
};

/// Measures a block in a new process, the `program` with its arguments (it serves `kBlockCommand`),
/// and passes the events on as they come. The process ends when this one does. Returns how it broke
/// down; nothing where it measured the block. Throws InputError where it cannot be started or
/// refuses the block, because a file has changed since the plan was made.
std::optional<BrokenBlock> measure_in_process(const Block& block,
                                              const std::vector<std::string>& program,
                                              const BlockWatch& watch);

/// Measures a block in this process, or times its candidates (`Block::tunes`).
void measure_here(const Block& block, const GoogleBenchmark& benchmark, const BlockWatch& watch);

/// Reads a block, measures it and writes the events; `activity` is where this process records what
/// it is doing. Returns the exit code.
int serve_block(plugin::Activity& activity);

}  // namespace beambench::measure
