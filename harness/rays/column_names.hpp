#pragma once
// Parses the column names in files of rays and hits.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace beambench::rays {

/// Returns the index of each name among the `known` ones, ignoring case. Returns nothing if none is
/// known: the line does not consist of column names. Throws InputError with a message that begins
/// with `place` for an unknown or duplicate name, and for columns that are not separated by commas.
std::optional<std::vector<std::size_t>> places_of_columns(const std::string& place,
                                                          std::span<const std::string> names,
                                                          std::span<const std::string_view> known);

}  // namespace beambench::rays
