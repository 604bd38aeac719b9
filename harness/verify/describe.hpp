#pragma once
// Formats a mismatch as text, and the command that traces its ray again.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "accel/core/registry.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/verify/diff_report.hpp"
#include "scenes/scene.hpp"

namespace beambench::verify {

/// A command to be pasted into a shell: `beambench trace SCENE --accel A --pixel X,Y ...` for a ray
/// of an image, `... --rays KIND --ray N ...` for one of a list. Scenes from files are named by
/// their path as given.
class ReplayCommand {
 public:
  /// `program` is the command for the program with its plug-ins (`plugin::program_call`); `image`
  /// is the image from which the rays come, primary or not; `frame` is the frame of an animated
  /// scene.
  ReplayCommand(std::string_view program, const scenes::Scene& scene,
                const rays::ImageOfRays& image, const accel::StructureChoice& structure,
                const rays::TraceInput& input, std::uint32_t frame = 0);

  std::string of(std::size_t index) const;

 private:
  rays::TraceInput input_;
  std::string subject_;  ///< scene and structure
  std::string image_;    ///< resolution, samples, camera
};

/// Describes a mismatch: its place, ray, both results, the exact one, and the reason for its class.
/// `subject` is the source of the result, in at most nine letters.
std::string describe(const scenes::Scene& scene, std::string_view place, const Mismatch& mismatch,
                     std::string_view subject);
/// Describes a program's result, whose ray is identified by its index alone.
std::string describe(const scenes::Scene& scene, const Mismatch& mismatch);
/// Describes a structure's result, with the place in the input.
std::string describe(const scenes::Scene& scene, const rays::TraceInput& input,
                     const Mismatch& mismatch);
/// Describes the same, followed by the command that shows the ray's traversal path.
std::string describe(const scenes::Scene& scene, const rays::TraceInput& input,
                     const Mismatch& mismatch, const ReplayCommand& replay);

/// Returns a mismatch as JSON: index, class, reason, ray, and the hits; `reported` is the result.
nlohmann::ordered_json to_json(const Mismatch& mismatch);

}  // namespace beambench::verify
