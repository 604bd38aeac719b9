#pragma once
// What part of the times is the harness's own.

#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace beambench::bench {

/// The harness's own share of a trace (`harness_ms`) in the cell where it is the largest part of
/// the contender's time, among those of one query path.
struct Overhead {
  std::string path;  ///< the QueryPath, by name
  std::string cell;  ///< its name
  double part;       ///< of its median trace time
};

/// One for each path with right answers among finished cells (their JSON files), the largest first.
/// Structures that trace images by samples of their own have none, nor whole pictures, whose
/// shading is wanted.
std::vector<Overhead> largest_overheads(std::span<const nlohmann::ordered_json> cells);

/// `harness overhead: at most 1.2% of a contender's trace time for images by single rays
/// (tetra.../samet), ...`, and where the times without it are. Of at least one.
std::string describe(std::span<const Overhead> overheads);

/// The largest, and each by its path; null where there is none.
nlohmann::ordered_json to_json(std::span<const Overhead> overheads);

}  // namespace beambench::bench
