#pragma once
// Verifying structures over a scene: against the oracle, and bit for bit among themselves.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/base/progress.hpp"
#include "harness/verify/differ.hpp"

namespace beambench::verify {

/// What was found of one structure over one scene.
struct VerifiedCell {
  std::string scene;
  std::string rays;  ///< as `RayChoice::label`
  std::uint64_t primitives = 0;
  std::string structure;   ///< the bare name
  std::string parameters;  ///< all of them, canonical
  std::string label;       ///< the name and the parameters that are not at their defaults
  std::string rays_hash;   ///< empty where the rays follow from the hits, as those of pictures

  std::optional<DiffReport> report;   ///< absent where nothing was verified
  std::vector<std::string> disputes;  ///< rays described, errors first
  std::string bits_reference;        ///< the structure whose bits it was compared with; empty: none
  std::uint64_t different_bits = 0;  ///< rays whose hit differs from the reference's
  Verdict verdict = Verdict::kError;
  std::string message;  ///< why nothing was verified
  std::string picture;  ///< file of the differences; empty: none was made

  bool has_rays() const { return verdict != Verdict::kNoRays; }
  /// Was something verified? Not where there are no rays or the structure does not take them.
  bool was_possible() const { return has_rays() && verdict != Verdict::kUnsupported; }
  /// Was nothing found to be wrong?
  bool passed() const { return is_right(verdict) || !was_possible(); }
};

/// The rays that are traced over a scene, which outlives it.
struct VerifiedView {
  const scenes::Scene& scene;
  rays::ImageOfRays image;
  rays::TraceInput input;
  int threads = 1;      ///< that trace the image
  std::string program;  ///< how this program is called, for the commands that replay a ray
};

/// Verifies one structure and fills the rest of its cell; may throw InputError.
using VerifyInto = std::function<void(const accel::StructureChoice& choice, VerifiedCell& cell)>;
/// Verifies each contender, the exhaustive search first where it is among them. `progress` gets one
/// cell for each; one that throws gets the verdict "error".
std::vector<VerifiedCell> verify_each(const scenes::Scene& scene, const std::string& rays,
                                      std::vector<accel::StructureChoice> contenders,
                                      base::Progress& progress, const VerifyInto& verify_into);

/// Draws the classes of the rays, where they are an image's and some are wrong; returns the file.
using DrawDifferences = std::function<std::string(
    const ReferenceHits& reference, std::span<const DiffClass> classes, const VerifiedCell& cell)>;

/// Verifies each contender, the exhaustive search first where it is among them: the bit-exact ones
/// are compared with it, or with the first of them. `progress` gets one cell for each contender.
std::vector<VerifiedCell> verify_scene(const VerifiedView& view,
                                       std::vector<accel::StructureChoice> contenders,
                                       base::Progress& progress,
                                       const DrawDifferences& draw_differences = {});

/// The cells of rays of a kind that the scene has none of, and why. `progress` gets each.
std::vector<VerifiedCell> cells_without_rays(const scenes::Scene& scene, const std::string& rays,
                                             std::vector<accel::StructureChoice> contenders,
                                             base::Progress& progress, const std::string& why);

nlohmann::ordered_json to_json(const VerifiedCell& cell);

}  // namespace beambench::verify
