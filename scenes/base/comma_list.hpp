#pragma once
// Lists that a user types, separated by commas.

#include <string>
#include <string_view>

namespace beambench {

/// Removes blanks at both ends of a list and beside its commas: `a, b` is `a,b`.
std::string without_blanks_at_commas(std::string_view list);

}  // namespace beambench
