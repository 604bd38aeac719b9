#pragma once
// Texts in which every character of the formats that are read here is one byte.

#include <string_view>

namespace beambench {

/// Returns the text without the byte order mark of UTF-8 that some editors write before it. Throws
/// InputError naming the file when it is UTF-16: it begins with that byte order mark, or one of its
/// first two bytes is 0.
std::string_view plain_text(std::string_view bytes, std::string_view file);

}  // namespace beambench
