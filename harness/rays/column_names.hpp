#pragma once
// The names of columns in files of rays and hits.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace beambench::rays {

/// Returns the place of each name among the `known` ones; upper and lower case are the same.
/// Nothing where none is known: the names are not those of columns. Throws InputError, which begins
/// with `place`, for a name that is unknown or there twice, and for columns that are not separated
/// by commas.
std::optional<std::vector<std::size_t>> places_of_columns(const std::string& place,
                                                          std::span<const std::string> names,
                                                          std::span<const std::string_view> known);

}  // namespace beambench::rays
