#pragma once
// Where two answers to the same rays differ, as a picture.

#include <filesystem>
#include <span>
#include <string>

#include "harness/verify/differ.hpp"

namespace beambench::cli {

/// Who was compared with whom.
struct ComparedNames {
  std::string judged;     ///< whose errors are `DiffClass::kStructureError`
  std::string reference;  ///< whose errors are `DiffClass::kEmbreeError`
};

/// `kOracleName` as a reference stands for the oracle itself.
inline constexpr const char* kOracleName = "oracle";

/// Writes the classes of the rays of an image (of primary rays) over a gray preview
/// of what the reference sees; a pixel shows the gravest class of its samples. A .png gets a
/// legend; an .exr the preview in colors and the classes as numbers (0 agree, 1 tie, 2 graze, 3
/// the judged is wrong, 4 the reference is).
void write_difference(const std::filesystem::path& file, const verify::ReferenceHits& reference,
                      std::span<const verify::DiffClass> classes, const ComparedNames& comparison);

/// A structure's hits as reference; answers that are none count as misses.
verify::ReferenceHits reference_from(const scenes::Scene& scene, const rays::TraceInput& input,
                                     const rays::TraceResults& results);

}  // namespace beambench::cli
