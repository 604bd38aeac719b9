#pragma once
// "Did you mean ...?"

#include <span>
#include <string>
#include <string_view>

namespace beambench {

/// The name with the smallest edit distance to `word` (Levenshtein 1966); ties go to the first.
/// Empty when there are no names.
std::string nearest_name(std::string_view word, std::span<const std::string> names);

}  // namespace beambench
