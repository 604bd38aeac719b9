#pragma once
// The traversal path of one ray, its hits and their verification: as text and as JSON.

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

/// The facts about one ray.
struct RayPath {
  std::string structure;    ///< its short label
  rays::ImageOfRays image;  ///< the image that the rays belong to or start from
  const rays::TraceInput& input;
  std::vector<accel::TraceStep> steps;  ///< empty if the structure cannot list them
  std::map<std::string, std::uint64_t, std::less<>> counters;
  /// The ray, its hit when traced with all rays (unless `asked_all`: alone), the oracle's hit, and
  /// the class.
  Mismatch verified;
  std::optional<accel::Hit> alone;  ///< its closest hit when traced alone
  bool asked_all = true;            ///< whether all rays of the input were traced
  /// The beams that contain the sample. If there are any, the steps are those of the sample in its
  /// beams.
  std::vector<accel::BeamPassage> beams;
};

/// Builds the structure and traces ray `index` of the input, together with all the others unless
/// `alone`. `input` must outlive the result.
RayPath trace_path(const accel::StructureChoice& choice, const scenes::Scene& scene,
                   const rays::ImageOfRays& image, const rays::TraceInput& input, std::size_t index,
                   bool alone, base::Progress& progress);

/// Returns one paragraph for each step.
std::string to_text(const scenes::Scene& scene, const RayPath& path);

/// Returns all data, with unrounded numbers; infinite values and misses are null.
nlohmann::ordered_json to_json(const scenes::Scene& scene, const RayPath& path);

}  // namespace beambench::verify
