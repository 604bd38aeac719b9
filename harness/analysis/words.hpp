#pragma once
// Describes the conclusions of a run in words.

#include <span>
#include <string>

#include "harness/analysis/analysis.hpp"

namespace beambench::analysis {

/// A break-even ray count: `the first ray`, `2.16 k rays`, `never`.
std::string rays_in_words(double rays);

/// A line for each view: the fastest, the next, Embree's best, and from how many rays on the
/// fastest pays off; then the geometric means over all views, where there are several.
std::string describe(std::span<const Standings> views);

/// Returns a table for each view with a line for each contender: build, trace, ratio to the
/// fastest.
std::string describe_contenders(std::span<const Standings> views);

/// Returns two lines, one on the hits and one on how far times can be trusted; a third on rays that
/// scenes lack.
std::string describe_verdicts(const Analysis& analysis);

/// Returns `harness overhead: at most 1.2% of a contender's trace time for images by single rays
/// (tetra.../samet), ...`, and where the times without it are. `overheads` is not empty.
std::string describe(std::span<const Overhead> overheads);

/// Returns a line for each structure over the frames of a scene that moves: what an update saves,
/// and how often it should be built anew.
std::string describe(std::span<const FrameSeries> series);

/// Returns the text of summary.txt: who is fastest, and the verdicts.
std::string summary(const Analysis& analysis);

}  // namespace beambench::analysis
