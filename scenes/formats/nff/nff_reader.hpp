#pragma once
// Reads Haines's Neutral File Format (NFF).

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/catalogue.hpp"

namespace beambench::scenes::nff {

/// A scene read from NFF and the warnings about it (unknown words and degenerate primitives that
/// were skipped, fields that were ignored, repaired polygons), each as `file:line: message`. A
/// warning that occurs often is reported once, with a count.
struct NffResult {
  Scene scene;
  std::vector<std::string> warnings;
};

/// Parses NFF text (Haines, "A Proposal for Standard Graphics Environments", 1987, with the words
/// that the thesis adds; quirks of files in the wild are listed in scenes/README.md). `file` is
/// used in messages and as the scene's name. Throws InputError with file, line and word if the text
/// is malformed or truncated, has a number that is not finite or beyond 1e9, or has no command, for
/// Sense8 WTK files (first word `nff`), and for any problem that the options do not allow. A text
/// without primitives yields an empty scene, which `load_scene` refuses.
NffResult parse_nff(std::string_view text, const std::string& file, ReadOptions options = {});

/// Reads and parses a file; also throws InputError if it cannot be read completely (`read_input`),
/// for example because it is larger than 4 GiB.
NffResult read_nff(const std::filesystem::path& path, ReadOptions options = {});

}  // namespace beambench::scenes::nff
