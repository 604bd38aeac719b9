#pragma once
// How a generated scene grows with its size.

#include <cstddef>
#include <string>

namespace beambench::cli {

enum class GrowthForm { kText, kJson, kCsv };

inline constexpr std::size_t kLargestGrowth = 10000000;

/// Generates the scene in growing sizes, each of about twice the primitives of the one before, as
/// long as they do not exceed the limit, and prints primitives, bytes and seconds of each. `spec`
/// is a catalogue name, with any parameters but the one that is its size. Throws InputError when
/// the scene has no size.
void show_growth(const std::string& spec, std::size_t limit, GrowthForm form);

}  // namespace beambench::cli
