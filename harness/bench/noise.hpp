#pragma once
// How much the machine is disturbed by others.

#include <chrono>
#include <optional>
#include <span>

namespace beambench::bench {

/// Keeps the calling core busy, so that its clock and caches leave their idle state before the
/// first repetition, and times slices of equal work meanwhile. Returns the noise of the second
/// half; nothing when the time was too short to tell.
std::optional<double> warm_up(std::chrono::duration<double> duration);

/// How much longer than the median slice the slowest twentieth took, as a part of the median: work
/// that never changes takes longer only because of others (interrupts, other tenants, the clock).
/// Nothing for fewer than 40 slices.
std::optional<double> noise(std::span<const double> slices);

}  // namespace beambench::bench
