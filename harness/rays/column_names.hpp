#pragma once
// Parses the column names of ray files and hit files.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace beambench::rays {

/// Returns each name's index in `known`, ignoring case. Returns nothing if no name is known: the
/// line does not consist of column names. Throws InputError with a message that begins with `place`
/// for an unknown or duplicate name, and for columns that are not separated by commas.
std::optional<std::vector<std::size_t>> places_of_columns(const std::string& place,
                                                          std::span<const std::string> names,
                                                          std::span<const std::string_view> known);

}  // namespace beambench::rays
