#pragma once
// What part of the times is the harness's own.

#include <optional>
#include <span>
#include <string>

#include <nlohmann/json.hpp>

namespace beambench {

/// The harness's own time (harness_time.hpp) beside the contender's whose trace is the quickest in
/// comparison.
struct Overhead {
  std::string cell;  ///< its name
  double part;       ///< of its median trace time
};

/// The cell where that part is largest, among finished cells with right answers (their JSON files);
/// nothing where there is none.
std::optional<Overhead> largest_overhead(std::span<const nlohmann::ordered_json> cells);

/// `harness overhead: at most 1.2% of a contender's trace time (tetra.../embree); ...`, saying
/// where the times without it stand.
std::string describe(const Overhead& overhead);

nlohmann::ordered_json to_json(const std::optional<Overhead>& overhead);

}  // namespace beambench
