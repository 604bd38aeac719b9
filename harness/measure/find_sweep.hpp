#pragma once
// Finds sweeps by name: those that come with beambench.

#include <filesystem>
#include <string>
#include <vector>

namespace beambench::measure {

/// Returns the names of the sweeps that come with beambench, sorted: `quick`, `thesis/table-5.1`.
std::vector<std::string> sweep_names();

/// Returns the file of a sweep that a user named, by path or by name. A path below
/// harness/bench/sweeps, where sweeps used to be, gives a warning (to be removed after one
/// version). Throws InputError that lists the names where there is neither file nor name.
std::filesystem::path find_sweep(const std::string& asked);

}  // namespace beambench::measure
