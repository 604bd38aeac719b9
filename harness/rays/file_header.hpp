#pragma once
// The second line of binary files of rays and hits: a JSON object.

#include <filesystem>
#include <optional>
#include <string_view>

#include <nlohmann/json.hpp>

namespace beambench::rays {

/// The object that the line of a file holds. Throws InputError naming the file when there is no
/// line, or it is no such object; `remedy` ends the sentence.
nlohmann::ordered_json parse_file_header(const std::filesystem::path& path,
                                         std::optional<std::string_view> line,
                                         std::string_view remedy);

}  // namespace beambench::rays
