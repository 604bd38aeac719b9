#pragma once
// The manifest of a run: what was measured, by which program and where, and which conditions could
// not be controlled.

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/measure/record/cell_record.hpp"
#include "harness/measure/record/conditions.hpp"
#include "harness/measure/record/machine.hpp"
#include "harness/measure/record/shard.hpp"
#include "harness/plugin/load_plugin.hpp"

namespace beambench::measure {

/// One scene of a run.
struct SceneFacts {
  std::string name;
  std::uint64_t hash;
  std::uint64_t primitives;
};

/// The conditions under which timed code ran.
struct MeasurementFacts {
  bool flush_to_zero;     ///< MXCSR's FTZ and DAZ bits were set for every contender
  int pinned_core;        ///< -1 if the thread could not be pinned
  unsigned control_word;  ///< MXCSR in the timed code
  double warm_up_seconds;
  std::string simd_target;           ///< Highway's best target here, used by beambench's SIMD
  std::optional<double> noise;       ///< noise of equal work in the warm-up (`noise`)
  std::optional<double> other_work;  ///< processors that others kept busy in the warm-up
  std::string hardware_problem;      ///< why hardware counters are not read; empty if they are read
  /// Throttling of the whole run, including the parts before it was resumed; nothing: no quota.
  std::optional<Throttling> throttling{};
};

struct Manifest {
  RunFacts run;
  std::string sweep;  ///< the configuration's name
  std::string begun_utc;
  std::string part_begun_utc;  ///< later than `begun_utc` if the run was resumed
  std::string finished_utc;    ///< empty unless the run has finished
  Machine machine;
  MeasurementFacts measurement;
  std::vector<plugin::LoadedPlugin> plugins;
  std::vector<SceneFacts> scenes;         ///< scenes of the whole sweep, even for a shard
  std::optional<ShardFacts> shard;        ///< nothing: the run is the whole sweep
  std::vector<std::string> uncontrolled;  ///< sentences
  nlohmann::ordered_json google_benchmark = nlohmann::ordered_json::object();  ///< its context
  /// The conditions of earlier parts of a run that was cut off and resumed.
  nlohmann::ordered_json earlier_parts = nlohmann::ordered_json::array();
};

/// Makes `now` the manifest of a run that was begun with the manifest `before` and is being
/// resumed. The throttling then includes that of the earlier parts.
void continue_with(Manifest& now, const nlohmann::ordered_json& before);

nlohmann::ordered_json to_json(const Manifest& manifest);

/// Returns two lines about the machine, and a warning in plain words for each condition that could
/// not be controlled.
std::vector<std::string> preflight(const Manifest& manifest);

/// Makes the manifest of a new run of the sweep `sweep`. After a warm-up, the timed code runs on
/// `threads` threads, pinned to `core` (-1: not pinned). `shard` is the part of the sweep that the
/// run measures. All other facts are read from this program, the machine (its quota below `root`,
/// as in `cpu_quota`) and Embree.
Manifest begin_manifest(const std::string& sweep, std::vector<SceneFacts> scenes, int core,
                        int threads, std::chrono::duration<double> warm_up,
                        std::optional<ShardFacts> shard = std::nullopt,
                        const std::filesystem::path& root = "/");

}  // namespace beambench::measure
