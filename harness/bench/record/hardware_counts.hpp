#pragma once
// What the processor counted during a phase of a repetition.

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace beambench::bench {

/// The events, as columns name them behind the phase: `trace_instructions`.
inline constexpr std::array<std::string_view, 3> kHardwareEvents{"instructions", "cycles",
                                                                 "cache_misses"};

/// One count for each event; nothing for one that this machine does not count.
using HardwareCounts = std::array<std::optional<std::uint64_t>, kHardwareEvents.size()>;

}  // namespace beambench::bench
