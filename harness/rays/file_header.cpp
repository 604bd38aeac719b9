#include "harness/rays/file_header.hpp"

#include <string>

#include <fmt/format.h>

#include "scenes/base/error.hpp"
#include "scenes/base/json_text.hpp"

namespace beambench::rays {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& why,
                         std::string_view remedy) {
  throw InputError(
      fmt::format("{}: the second line is not a JSON object{}; {}", path.string(), why, remedy));
}

}  // namespace

nlohmann::ordered_json parse_file_header(const std::filesystem::path& path,
                                         std::optional<std::string_view> line,
                                         std::string_view remedy) {
  nlohmann::ordered_json header;
  try {
    if (line) header = parse_json<nlohmann::ordered_json>(*line, "it");
  } catch (const InputError& error) {
    refuse(path, fmt::format(" ({})", error.what()), remedy);
  }
  if (!header.is_object()) refuse(path, "", remedy);
  return header;
}

}  // namespace beambench::rays
