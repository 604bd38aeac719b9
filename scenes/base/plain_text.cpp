#include "scenes/base/plain_text.hpp"

#include <fmt/format.h>

#include "scenes/base/error.hpp"

namespace beambench {

std::string_view plain_text(std::string_view bytes, std::string_view file) {
  constexpr std::string_view kUtf8 = "\xEF\xBB\xBF";
  const bool is_marked = bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF");
  const bool has_wide_letter = bytes.size() > 1 && (bytes[0] == '\0') != (bytes[1] == '\0');
  if (is_marked || has_wide_letter) {
    throw InputError(
        fmt::format("{}: it is UTF-16, which is not supported; save it as UTF-8", file));
  }
  if (bytes.starts_with(kUtf8)) bytes.remove_prefix(kUtf8.size());
  return bytes;
}

}  // namespace beambench
