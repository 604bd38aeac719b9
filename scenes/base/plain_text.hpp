#pragma once
// Prepares texts in which all relevant characters are single bytes.

#include <string_view>

namespace beambench {

/// Returns the text without the UTF-8 byte order mark that some editors write. Throws InputError
/// with the file name if the text is UTF-16, that is, if it begins with a UTF-16 byte order mark or
/// one of its first two bytes is 0.
std::string_view plain_text(std::string_view bytes, std::string_view file);

}  // namespace beambench
