#pragma once
// Judging structures over a scene: against the oracle, and bit for bit among themselves.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/base/progress.hpp"
#include "harness/verify/differ.hpp"

namespace beambench::cli {

/// The judgment of one structure over one scene.
struct VerifiedCell {
  std::string scene;
  std::string rays;  ///< as `RayChoice::label`
  std::uint64_t primitives = 0;
  std::string structure;   ///< the bare name
  std::string parameters;  ///< all of them, canonical
  std::string label;       ///< the name and the parameters that are not at their defaults

  std::optional<verify::DiffReport> report;  ///< absent where nothing was judged
  std::vector<std::string> disputes;         ///< rays described, errors first
  std::string bits_reference;                ///< whose bits it was compared with; empty: nobody's
  std::uint64_t different_bits = 0;          ///< rays whose answer differs from the reference's
  verify::Verdict verdict = verify::Verdict::kError;
  std::string message;            ///< why nothing was judged
  std::filesystem::path picture;  ///< of the differences; empty: none was made

  bool has_rays() const { return verdict != verify::Verdict::kNoRays; }
  /// Was nothing found to be wrong?
  bool passed() const { return verify::is_right(verdict) || !has_rays(); }
};

/// What the contenders over a scene are asked. The scene outlives it.
struct VerifiedView {
  const scenes::Scene& scene;
  rays::ImageOfRays image;
  rays::TraceInput input;
  int threads = 1;  ///< that trace the image
};

/// Judges one structure into its cell, which is filled but for that; may throw InputError.
using JudgeInto = std::function<void(const accel::StructureChoice& choice, VerifiedCell& cell)>;
/// Judges each contender, the exhaustive search first where it is among them. `progress` gets one
/// cell for each; one that throws gets the verdict "error".
std::vector<VerifiedCell> verify_each(const scenes::Scene& scene, const std::string& rays,
                                      std::vector<accel::StructureChoice> contenders,
                                      base::Progress& progress, const JudgeInto& judge_into);

/// Judges each contender, the exhaustive search first where it is among them: the bit-exact ones
/// are compared with it, or with the first of them. `progress` gets one cell for each contender.
/// Unless `pictures` is empty, each cell with wrong answers to primary rays leaves a picture in
/// that folder.
std::vector<VerifiedCell> verify_scene(const VerifiedView& view,
                                       std::vector<accel::StructureChoice> contenders,
                                       const std::filesystem::path& pictures,
                                       base::Progress& progress);

/// The cells of rays of a kind that the scene has none of, and why. `progress` gets each.
std::vector<VerifiedCell> cells_without_rays(const scenes::Scene& scene, const std::string& rays,
                                             std::vector<accel::StructureChoice> contenders,
                                             base::Progress& progress, const std::string& why);

nlohmann::ordered_json to_json(const VerifiedCell& cell);

}  // namespace beambench::cli
