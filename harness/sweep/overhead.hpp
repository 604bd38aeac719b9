#pragma once
// What part of the times is the harness's own.

#include <optional>
#include <span>
#include <string>

#include <nlohmann/json.hpp>

namespace beambench {

/// `null` makes every ray and writes every answer, but looks for none: its trace time beside that
/// of the fastest contender of the same rays.
struct Overhead {
  std::string view;     ///< `tetra:n=6/default/320x200/1/primary`
  std::string fastest;  ///< the contender
  double part;          ///< of the fastest contender's median trace time
};

/// The rays where that part is largest, among finished cells (their JSON files); nothing where
/// `null` was not measured beside anything else.
std::optional<Overhead> largest_overhead(std::span<const nlohmann::ordered_json> cells);

/// `harness overhead (null): at most 1.2% of the fastest contender's trace time (embree,
/// tetra...)`.
std::string describe(const Overhead& overhead);

nlohmann::ordered_json to_json(const std::optional<Overhead>& overhead);

}  // namespace beambench
