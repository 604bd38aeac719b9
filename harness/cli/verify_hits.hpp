#pragma once
// `beambench verify SCENE --rays FILE --hits FILE`, `--command COMMAND`, and `--kit DIR`.

#include <filesystem>
#include <optional>
#include <string>

#include "accel/core/registry.hpp"
#include "harness/cli/inputs.hpp"
#include "harness/verify/differ.hpp"
#include "harness/verify/minimize.hpp"

namespace beambench::cli {

/// The source of hits: files, a command, or a structure.
struct VerifyHitsRequest {
  std::string scene;                                  ///< empty for a kit
  std::string kit;                                    ///< its folder; empty: none
  std::string rays;                                   ///< empty for a kit
  std::string hits;                                   ///< empty: from a command or from the kit
  std::string command;                                ///< empty: none
  std::optional<accel::StructureChoice> structure{};  ///< traces a kit
  ViewRequest view;                                   ///< of the picture
  std::string resolution;                             ///< of the picture
  std::string json;                                   ///< empty: none
  std::string pictures;                               ///< folder; empty: none
  std::string minimize;                               ///< folder; empty: none
  double timeout = kDefaultTimeout;                   ///< of a plug-in's action, in seconds
};

/// Verifies the hits of one scene, prints the findings and returns the exit code.
int verify_hits(const VerifyHitsRequest& request);
/// Verifies all scenes of a kit in the same way.
int verify_kit(const VerifyHitsRequest& request);

/// Explains the column "oracle error" if `any` oracle error was found.
void print_oracle_note(bool any);

/// Returns a line about the reduced error in that folder and, with the option that names the
/// source of the hits ("--accel mine"), the command that verifies it again.
std::string case_text(const std::filesystem::path& folder, const verify::MinimalCase& minimal,
                      const std::string& option);

/// Reduces the fault `wrong`, writes the case below `folder`, and returns the text to print about
/// it. `camera` is the camera of an image's rays if it is not the scene's first.
std::string minimized_text(const std::string& folder, const std::string& name,
                           const scenes::Scene& scene, const rays::TraceInput& input,
                           const verify::Mismatch& wrong, const verify::FindWrong& find_wrong,
                           const std::string& subject, const std::string& option,
                           const scenes::Camera* camera = nullptr);

}  // namespace beambench::cli
