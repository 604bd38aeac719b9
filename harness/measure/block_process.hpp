#pragma once
// Measures blocks in separate processes, which run this program with a special command. Such a
// process reads a block from its standard input and writes events to its standard output, each as
// one line of JSON.

#include <optional>
#include <string>
#include <vector>

#include "harness/measure/block.hpp"
#include "harness/plugin/activity.hpp"

namespace beambench::measure {

/// The command with which a program serves blocks (`serve_block`); not for users.
inline constexpr const char* kBlockCommand = "measure-block";

/// The failure of a process before its block was finished.
struct BrokenBlock {
  std::optional<std::size_t> cell;  ///< the cell being measured, by its index in the plan
  std::string how;                  ///< a clause: "it crashed (SIGSEGV: Segmentation fault)"
};

/// Measures a block in a new process and passes the events on as they arrive. The process runs
/// `program` with its arguments, which serves `kBlockCommand`, and ends when this process ends.
/// Returns how the process failed; nothing if it measured the block. Throws InputError if the
/// process cannot be started, or refuses the block because a file has changed since the plan was
/// made.
std::optional<BrokenBlock> measure_in_process(const Block& block,
                                              const std::vector<std::string>& program,
                                              const BlockWatch& watch);

/// Measures a block in this process, or times its candidates if `Block::tunes`.
void measure_here(const Block& block, const GoogleBenchmark& benchmark, const BlockWatch& watch);

/// Reads a block, measures it and writes the events; this process records in `activity` what it is
/// doing. Returns the exit code.
int serve_block(plugin::Activity& activity);

}  // namespace beambench::measure
