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
};

/// Verifies the hits of one scene, prints the findings and returns the exit code.
int verify_hits(const VerifyHitsRequest& request);
/// Verifies all scenes of a kit in the same way.
int verify_kit(const VerifyHitsRequest& request);

/// Explains the column "oracle error" if `any` oracle error was found.
void print_oracle_note(bool any);

/// Returns one line about the reduced error in a folder.
std::string case_text(const std::filesystem::path& folder, const verify::MinimalCase& minimal);

/// Reduces a structure's first error, writes the case below `folder`, and returns the text to print
/// about it.
std::string minimized_text(const std::string& folder, const std::string& name,
                           const scenes::Scene& scene, const rays::TraceInput& input,
                           const verify::DiffReport& report, const verify::Tracer& tracer,
                           const std::string& subject, base::Progress& progress);

}  // namespace beambench::cli
