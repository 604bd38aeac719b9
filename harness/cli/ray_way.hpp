#pragma once
// One ray's way through a structure, its answers and their judgement: as text and as JSON.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "accel/accelerator.hpp"
#include "harness/differ/differ.hpp"

namespace beambench {

/// What is known of one ray.
struct RayWay {
  std::string structure;  ///< its short label
  int width, height, samples;
  std::vector<TraceStep> steps;  ///< empty where the structure cannot tell them
  std::map<std::string, std::uint64_t, std::less<>> counters;
  /// The ray, its answer in the image (or, unless `in_image`, asked alone), the oracle's, the
  /// class.
  Mismatch judgement;
  std::optional<Hit> alone;  ///< the answer to the ray asked alone
  bool in_image = true;      ///< was the whole image traced?
};

/// For people: one paragraph for each step.
std::string to_text(const Scene& scene, const RayWay& way);

/// All of it, numbers as they are; what is infinite or a miss is null.
nlohmann::ordered_json to_json(const Scene& scene, const RayWay& way);

}  // namespace beambench
