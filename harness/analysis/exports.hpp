#pragma once
// The files made from the log of a run.

#include <filesystem>

#include "harness/analysis/analysis.hpp"

namespace beambench::analysis {

/// Reads the log in a folder, analyzes it and writes config.json, manifest.json, results.csv,
/// analysis.json, summary.txt and google-benchmark.json beside it. Throws InputError if the log
/// cannot be read or a file cannot be written.
Analysis conclude(const std::filesystem::path& folder);

}  // namespace beambench::analysis
