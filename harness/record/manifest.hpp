#pragma once
// The manifest of a run: what was measured, by what, where, and what could not be controlled.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/record/cell_record.hpp"
#include "harness/record/machine.hpp"

namespace beambench {

/// One scene of a run.
struct SceneFacts {
  std::string name;
  std::uint64_t hash;
  std::uint64_t primitives;
};

/// How the timed code was run.
struct MeasurementFacts {
  bool flush_to_zero;  ///< MXCSR's FTZ and DAZ bits were set for every contender
  int pinned_core;     ///< -1 where the thread could not be pinned
  double warm_up_seconds;
};

struct Manifest {
  RunFacts run;
  std::string sweep;  ///< the configuration's name
  std::string begun_utc;
  std::string finished_utc;  ///< empty while the run goes on, or when it was cut off
  Machine machine;
  MeasurementFacts measurement;
  std::vector<SceneFacts> scenes;
  std::vector<std::string> uncontrolled;  ///< sentences
};

nlohmann::ordered_json to_json(const Manifest& manifest);

}  // namespace beambench
