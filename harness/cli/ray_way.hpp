#pragma once
// One ray's way through a structure, its answers and their judgment: as text and as JSON.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "accel/beam/sample_path.hpp"
#include "accel/core/accelerator.hpp"
#include "harness/verify/differ.hpp"

namespace beambench::cli {

/// What is known of one ray.
struct RayWay {
  std::string structure;    ///< its short label
  rays::ImageOfRays image;  ///< that the rays are of, or come from
  const rays::TraceInput& input;
  std::vector<accel::TraceStep> steps;  ///< empty where the structure cannot tell them
  std::map<std::string, std::uint64_t, std::less<>> counters;
  /// The ray, its answer among all rays (or, unless `asked_all`, alone), the oracle's, the
  /// class.
  verify::Mismatch judgment;
  std::optional<accel::Hit> alone;  ///< its closest hit, asked alone
  bool asked_all = true;            ///< were all rays of the input traced?
  /// With beams: those that the sample belongs to. The steps are then of the sample with its beams.
  std::vector<accel::beam::BeamPassage> beams;
};

/// For people: one paragraph for each step.
std::string to_text(const scenes::Scene& scene, const RayWay& way);

/// All of it, numbers as they are; what is infinite or a miss is null.
nlohmann::ordered_json to_json(const scenes::Scene& scene, const RayWay& way);

}  // namespace beambench::cli
