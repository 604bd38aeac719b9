#pragma once
// The traversal path of one ray, its hits and how they were verified: as text and as JSON.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "accel/core/accelerator.hpp"
#include "accel/core/registry.hpp"
#include "harness/base/progress.hpp"
#include "harness/verify/differ.hpp"

namespace beambench::verify {

/// What is known of one ray.
struct RayPath {
  std::string structure;    ///< its short label
  rays::ImageOfRays image;  ///< that the rays are of, or come from
  const rays::TraceInput& input;
  std::vector<accel::TraceStep> steps;  ///< empty where the structure cannot list them
  std::map<std::string, std::uint64_t, std::less<>> counters;
  /// The ray, its hit among all rays (or, unless `asked_all`, alone), the oracle's, the class.
  Mismatch verified;
  std::optional<accel::Hit> alone;  ///< its closest hit, traced alone
  bool asked_all = true;            ///< were all rays of the input traced?
  /// With beams: those that contain the sample. The steps are then of the sample with its beams.
  std::vector<accel::BeamPassage> beams;
};

/// Builds the structure and traces ray `index` of the input, unless `alone` with all the others.
/// `input` must outlive the result.
RayPath trace_path(const accel::StructureChoice& choice, const scenes::Scene& scene,
                   const rays::ImageOfRays& image, const rays::TraceInput& input, std::size_t index,
                   bool alone, base::Progress& progress);

/// One paragraph for each step.
std::string to_text(const scenes::Scene& scene, const RayPath& path);

/// All of it, numbers as they are; what is infinite or a miss is null.
nlohmann::ordered_json to_json(const scenes::Scene& scene, const RayPath& path);

}  // namespace beambench::verify
