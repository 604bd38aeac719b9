#pragma once
// Describes the conclusions of a run in words.

#include <span>
#include <string>

#include "harness/analysis/analysis.hpp"

namespace beambench::analysis {

/// Returns a break-even ray count: `the first ray`, `2.16 k rays`, `never`.
std::string rays_in_words(double rays);

/// Returns a line for each view: the fastest, the next, Embree's best, and the number of rays from
/// which the fastest pays off. If there are several views, geometric means over all of them follow.
std::string describe(std::span<const Standings> views);

/// Returns a table for each view, with a line for each contender: build, trace, ratio to the
/// fastest.
std::string describe_contenders(std::span<const Standings> views);

/// Returns a line on the hits and a line on how far the times can be trusted, with further lines
/// between them if cells have no rays or are unsupported.
std::string describe_verdicts(const Analysis& analysis);

/// Returns `harness overhead: at most 1.2% of a contender's trace time for images by single rays
/// (tetra.../samet), ...`, and where to find the times without it. `overheads` must not be empty.
std::string describe(std::span<const Overhead> overheads);

/// Returns a line for each structure over the frames of an animated scene: what an update saves,
/// and how often to rebuild.
std::string describe(std::span<const FrameSeries> series);

/// Returns the text of summary.txt: who is fastest, and the verdicts.
std::string summary(const Analysis& analysis);

}  // namespace beambench::analysis
