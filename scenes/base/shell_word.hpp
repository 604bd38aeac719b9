#pragma once
// Words of command lines that are printed to be pasted.

#include <string>
#include <string_view>

namespace beambench {

/// A word as a shell must be given it, and printable: as it is where that is safe, otherwise in
/// single quotes, or where some of it is not printable as bash, ksh and zsh read it, `$'esc\x1b'`.
std::string shell_quoted(std::string_view word);

}  // namespace beambench
