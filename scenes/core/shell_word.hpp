#pragma once
// Words of command lines that are printed to be pasted.

#include <string>
#include <string_view>

namespace beambench {

/// A word as a shell must be given it: as it is where that is safe, otherwise in single quotes.
std::string shell_quoted(std::string_view word);

}  // namespace beambench
