#pragma once
// Parses the second line of binary ray files and hit files: a JSON object.

#include <filesystem>
#include <optional>
#include <string_view>

#include <nlohmann/json.hpp>

namespace beambench::rays {

/// Parses the object in the header line of a file. Throws InputError with the file name if the line
/// is missing or not a JSON object; the message ends with `remedy`.
nlohmann::ordered_json parse_file_header(const std::filesystem::path& path,
                                         std::optional<std::string_view> line,
                                         std::string_view remedy);

}  // namespace beambench::rays
