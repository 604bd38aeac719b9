#pragma once
// Comma-separated lists that a user types.

#include <string>
#include <string_view>

namespace beambench {

/// Removes blanks at both ends of a list and beside its commas: `a, b` becomes `a,b`.
std::string without_blanks_at_commas(std::string_view list);

}  // namespace beambench
