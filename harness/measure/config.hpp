#pragma once
// The configuration of a sweep, which states what to measure, read from JSON.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "accel/core/registry.hpp"
#include "harness/rays/ray_kind.hpp"
#include "harness/rays/trace_input.hpp"

namespace beambench::measure {

/// A scene of a sweep.
struct SceneEntry {
  std::string spec;                  ///< a catalogue name with parameters, or a path
  std::vector<std::string> cameras;  ///< by name; empty: the scene's first
  std::string place;                 ///< its place in the file, for messages
};

/// Cells to leave out: those that meet all the given conditions.
struct Exclusion {
  std::optional<std::string> structure;  ///< the bare name
  std::optional<std::string> scene;      ///< as the configuration spells it
  std::optional<std::uint64_t> primitives_above;
  std::optional<std::uint64_t> rays_above;
  std::optional<bool> is_sorted;  ///< the order of a list
};

/// A contender of a sweep.
struct SweptStructure {
  /// Its parameter sets: one; or, where it is tuned, those of which the two fastest on the tuning
  /// camera are measured (tuning.hpp).
  std::vector<accel::StructureChoice> sets;
  bool is_tuned = false;
};

struct SweepConfig {
  std::string name;
  std::string description;
  std::vector<SceneEntry> scenes;
  std::vector<SweptStructure> structures;  ///< lists of parameters multiplied out
  std::vector<rays::Resolution> resolutions;
  std::vector<int> samples;
  std::vector<rays::RayChoice> rays;
  int threads;  ///< that trace an image
  double
      precision;  ///< wanted half-width of the prediction interval of a trace time, relative to it
  int blocks;     ///< of each view, where the precision does not need more
  int minimum_repetitions;
  int maximum_repetitions;
  int second_traces;      ///< of each cell: so many repetitions are followed by one
  double budget_seconds;  ///< for the whole run; the minimum of repetitions is made all the same
  std::chrono::duration<double> warm_up;  ///< of the machine, before anything is timed
  std::vector<Exclusion> exclude;

  nlohmann::json source;  ///< as it was read
};

/// Reads and checks a configuration, by path or by name (`find_sweep`; schema:
/// harness/measure/sweep.schema.json). Structures and their parameters are checked against
/// `structures`, which outlives the result. Throws InputError `file:
/// /structures/1/parameters/max_level: ...`, and where the lists multiply to more than 100,000
/// cells, which is determined before any is made.
SweepConfig read_sweep(const std::string& asked, const accel::Registry& structures);

/// Reads contenders as typed after `--accel`: "samet:max_level=6,embree:mode=best", "all". Throws
/// as `Registry::choose_list`.
std::vector<SweptStructure> read_structures(const std::string& text,
                                            const accel::Registry& structures);

/// Reads the same from a configuration in memory; `name` stands for it in messages.
SweepConfig parse_sweep(nlohmann::json source, const std::string& name,
                        const accel::Registry& structures);

}  // namespace beambench::measure
