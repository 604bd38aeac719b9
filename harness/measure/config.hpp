#pragma once
// The configuration of a sweep, read from JSON: what to measure.

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
  std::vector<std::string> cameras;  ///< names; empty: the scene's first camera
  std::string place;                 ///< its place in the file, for messages
};

/// Cells to leave out: those that meet all conditions given.
struct Exclusion {
  std::optional<std::string> structure;  ///< the bare name
  std::optional<std::string> scene;      ///< as spelled in the configuration
  std::optional<std::uint64_t> primitives_above;
  std::optional<std::uint64_t> rays_above;
  std::optional<bool> is_sorted;  ///< the order of a list
};

/// A contender of a sweep.
struct SweptStructure {
  /// Its parameter sets: one set or, if it is tuned, all candidates. Of the candidates, the two
  /// fastest with the tuning camera are measured (tuning.hpp).
  std::vector<accel::StructureChoice> sets;
  bool is_tuned = false;
};

struct SweepConfig {
  std::string name;
  std::string description;
  std::vector<SceneEntry> scenes;
  std::vector<SweptStructure> structures;  ///< all combinations of parameter values
  std::vector<rays::Resolution> resolutions;
  std::vector<int> samples;
  std::vector<rays::RayChoice> rays;
  int threads;       ///< number of threads that trace an image
  double precision;  ///< desired relative half-width of the prediction interval of a trace time
  int blocks;        ///< number per view, unless the precision needs more
  int minimum_repetitions;
  int maximum_repetitions;
  int second_traces;      ///< per cell: number of repetitions followed by a second trace
  double budget_seconds;  ///< for the whole run; the minimum number of repetitions is always made
  std::chrono::duration<double> warm_up;  ///< of the machine, before anything is timed
  std::vector<Exclusion> exclude;

  nlohmann::json source;  ///< as read
};

/// Reads and checks a configuration, by path or by name (`find_sweep`; schema:
/// harness/measure/sweep.schema.json). Structures and their parameters are checked against
/// `structures`, which must outlive the result. Throws InputError (`file:
/// /structures/1/parameters/max_level: ...`) for an invalid value, or if the lists multiply to more
/// than 100,000 cells, which is determined before any cell is created.
SweepConfig read_sweep(const std::string& asked, const accel::Registry& structures);

/// Reads contenders as typed after `--accel`: "samet:max_level=6,embree:mode=best", "all". Throws
/// what `Registry::choose_list` throws.
std::vector<SweptStructure> read_structures(const std::string& text,
                                            const accel::Registry& structures);

/// Reads the same from a configuration in memory; messages use `name` in place of a file name.
SweepConfig parse_sweep(nlohmann::json source, const std::string& name,
                        const accel::Registry& structures);

}  // namespace beambench::measure
