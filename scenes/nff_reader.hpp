#pragma once
// Reads Haines's Neutral File Format (NFF).

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene.hpp"

namespace beambench {

/// A scene read from NFF and what was noticed on the way (unknown words that were skipped,
/// repaired primitives), each as `file:line: message`.
struct NffResult {
  Scene scene;
  std::vector<std::string> warnings;
};

/// Parses NFF text (Haines, "A Proposal for Standard Graphics Environments", 1987; quirks of files
/// in the wild are listed in the README). `file` is used in messages and as the scene's name.
/// Throws InputError with file, line and word when the text is malformed or truncated, when a
/// primitive is degenerate or a number is not finite, and for Sense8 WTK files (first word `nff`).
NffResult parse_nff(std::string_view text, const std::string& file);

/// Reads and parses a file; throws InputError also when it cannot be read.
NffResult read_nff(const std::filesystem::path& path);

}  // namespace beambench
