#pragma once
// Quotes words of command lines that are printed for pasting.

#include <string>
#include <string_view>

namespace beambench {

/// Returns a word quoted for a shell, in printable form: unchanged if safe; in the form
/// `$'esc\x1b'` of bash, ksh and zsh if it has unprintable characters; otherwise in single quotes.
std::string shell_quoted(std::string_view word);

}  // namespace beambench
