#pragma once
// Finds beambench's own sweeps by name.

#include <filesystem>
#include <string>
#include <vector>

namespace beambench::measure {

/// Returns the names of beambench's own sweeps, sorted: `quick`, `thesis/table-5.1`.
std::vector<std::string> sweep_names();

/// Returns the file of a sweep specified by path or by name. A path below harness/bench/sweeps,
/// where sweeps used to be, causes a warning (to be removed after one version). Throws InputError
/// listing the names if it is neither a file nor a name.
std::filesystem::path find_sweep(const std::string& asked);

}  // namespace beambench::measure
