#pragma once
// One entry of a sweep's list of structures.

#include <vector>

#include "accel/core/registry.hpp"
#include "harness/bench/json_node.hpp"

namespace beambench::bench {

/// The structures that an entry stands for: a text as after `--accel` ("samet:max_level=6", "all"),
/// or an object {"structure": name, "parameters": {name: value or list of values}} whose lists are
/// multiplied out, the alphabetically last parameter varying fastest. Throws InputError at the very
/// value that the structure refuses.
std::vector<accel::StructureChoice> read_structure_entry(const JsonNode& node,
                                                         const accel::Registry& structures);

}  // namespace beambench::bench
