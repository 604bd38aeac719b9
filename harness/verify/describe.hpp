#pragma once
// One mismatch as text, and the command that traces the ray again.

#include <cstddef>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "accel/core/registry.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/verify/diff_report.hpp"
#include "scenes/scene.hpp"

namespace beambench::verify {

/// `beambench trace SCENE --accel A --pixel X,Y ...` for the rays of an image,
/// `... --rays KIND --ray N ...` for those of a list, to be pasted into a shell. Scenes from files
/// are named by their path as it was given.
class ReplayCommand {
 public:
  /// `program` is how the program is called, with its plug-ins (`plugin::program_call`); `image` is
  /// what the rays come from, primary or not.
  ReplayCommand(std::string_view program, const scenes::Scene& scene,
                const rays::ImageOfRays& image, const accel::StructureChoice& structure,
                const rays::TraceInput& input);

  std::string of(std::size_t index) const;

 private:
  rays::TraceInput input_;
  std::string subject_;  ///< scene and structure
  std::string image_;    ///< resolution, samples, camera
};

/// One mismatch as text: its place, ray, both results, the exact one, and why it is of its class.
/// `subject` is what gave the answer, in at most nine letters.
std::string describe(const scenes::Scene& scene, std::string_view place, const Mismatch& mismatch,
                     std::string_view subject);
/// The same of a program's answer, whose ray is known by its index alone.
std::string describe(const scenes::Scene& scene, const Mismatch& mismatch);
/// The same of a structure's answer, with the place in the input.
std::string describe(const scenes::Scene& scene, const rays::TraceInput& input,
                     const Mismatch& mismatch);
/// The same, and the command that shows the ray's traversal path.
std::string describe(const scenes::Scene& scene, const rays::TraceInput& input,
                     const Mismatch& mismatch, const ReplayCommand& replay);

/// The same as JSON: index, class, reason, ray, and the hits, `reported` being the answer.
nlohmann::ordered_json to_json(const Mismatch& mismatch);

}  // namespace beambench::verify
