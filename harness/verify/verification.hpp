#pragma once
// Verifies structures over a scene: against the oracle, and bit for bit among themselves.

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

/// The findings for one structure over one scene.
struct VerifiedCell {
  std::string scene;
  std::string rays;  ///< as `RayChoice::label`
  std::uint64_t primitives = 0;
  std::string structure;   ///< the bare name
  std::string parameters;  ///< all parameters, in canonical form
  std::string label;       ///< the name and the parameters that are not at their defaults
  std::string rays_hash;   ///< empty if the rays follow from the hits, as in pictures

  std::optional<DiffReport> report;   ///< absent if nothing was verified
  std::vector<std::string> disputes;  ///< descriptions of rays, errors first
  std::string bits_reference;         ///< structure with which its bits were compared; empty: none
  std::uint64_t different_bits = 0;   ///< rays whose hit differs from the reference's
  Verdict verdict = Verdict::kError;
  std::string message;  ///< why nothing was verified
  std::string picture;  ///< the picture file of the differences; empty: none

  bool has_rays() const { return verdict != Verdict::kNoRays; }
  /// Returns whether a verification was possible, with rays that the structure supports.
  bool was_possible() const { return has_rays() && verdict != Verdict::kUnsupported; }
  /// Returns whether no fault was found.
  bool passed() const { return is_right(verdict) || !was_possible(); }
};

/// The rays that are traced over a scene, which must outlive this object.
struct VerifiedView {
  const scenes::Scene& scene;
  rays::ImageOfRays image;
  rays::TraceInput input;
  int threads = 1;          ///< number of threads that trace the image
  std::string program;      ///< the command for this program, for replaying a ray
  std::uint32_t frame = 0;  ///< of an animated scene
};

/// A function that verifies one structure and fills in its cell; it may throw InputError.
using VerifyInto = std::function<void(const accel::StructureChoice& choice, VerifiedCell& cell)>;
/// Verifies each contender, starting with the exhaustive search if it is among them. `progress`
/// gets one cell for each; a contender that throws gets the verdict "error".
std::vector<VerifiedCell> verify_each(const scenes::Scene& scene, const std::string& rays,
                                      std::vector<accel::StructureChoice> contenders,
                                      base::Progress& progress, const VerifyInto& verify_into);

/// A function that draws the classes of an image's rays if some are wrong, and returns the file.
using DrawDifferences = std::function<std::string(
    const ReferenceHits& reference, std::span<const DiffClass> classes, const VerifiedCell& cell)>;

/// Verifies each contender, starting with the exhaustive search if it is among them: bit-exact
/// structures are compared with it or, if it is missing, with the first bit-exact one. `progress`
/// gets one cell for each contender.
std::vector<VerifiedCell> verify_scene(const VerifiedView& view,
                                       std::vector<accel::StructureChoice> contenders,
                                       base::Progress& progress,
                                       const DrawDifferences& draw_differences = {});

/// Returns cells for a kind of rays that the scene does not have, with the reason. `progress` gets
/// each cell.
std::vector<VerifiedCell> cells_without_rays(const scenes::Scene& scene, const std::string& rays,
                                             std::vector<accel::StructureChoice> contenders,
                                             base::Progress& progress, const std::string& why);

nlohmann::ordered_json to_json(const VerifiedCell& cell);

}  // namespace beambench::verify
