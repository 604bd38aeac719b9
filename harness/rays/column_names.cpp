#include "harness/rays/column_names.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/base/error.hpp"
#include "scenes/base/nearest_name.hpp"
#include "scenes/base/printable.hpp"

namespace beambench::rays {
namespace {

using KnownNames = std::span<const std::string_view>;

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

std::optional<std::size_t> place_among(KnownNames known, std::string_view name) {
  const auto found = std::ranges::find(known, lower_case(name));
  if (found == known.end()) return std::nullopt;
  return static_cast<std::size_t>(found - known.begin());
}

/// Returns whether a line names at least two known columns when split at that separator.
bool is_divided_by(char separator, std::string_view line, KnownNames known) {
  std::size_t found = 0;
  while (!line.empty()) {
    std::string name(line.substr(0, line.find(separator)));
    line.remove_prefix(std::min(name.size() + 1, line.size()));
    std::erase_if(name, [](char c) { return c == '"' || c == ' ' || c == '\t'; });
    if (place_among(known, name)) ++found;
  }
  return found > 1;
}

/// Throws InputError if names are separated by something other than a comma.
void require_commas(const std::string& place, std::span<const std::string> names,
                    KnownNames known) {
  struct Separator {
    char character;
    std::string_view name;
  };
  constexpr std::array<Separator, 4> kOthers{
      {{';', "semicolons"}, {'\t', "tabs"}, {'|', "'|'"}, {' ', "blanks"}}};
  if (names.size() != 1) return;
  for (const auto& [character, name] : kOthers) {
    if (!is_divided_by(character, names.front(), known)) continue;
    throw InputError(
        fmt::format("{}: the columns are separated by {}; expected commas, and numbers with a "
                    "decimal point",
                    place, name));
  }
}

[[noreturn]] void refuse_unknown(const std::string& place, std::size_t column,
                                 const std::string& name, KnownNames known) {
  const std::string expected = fmt::format("expected {}", fmt::join(known, ","));
  if (name.empty()) {
    throw InputError(
        fmt::format("{}: column {} has no name, like the index that pandas writes unless given "
                    "index=False; remove it or name it; {}",
                    place, column + 1, expected));
  }
  const std::vector<std::string> names(known.begin(), known.end());
  throw InputError(fmt::format("{}: column '{}' is unknown; {}remove it or rename it; {}", place,
                               excerpt(name), did_you_mean(lower_case(name), names), expected));
}

}  // namespace

std::optional<std::vector<std::size_t>> places_of_columns(const std::string& place,
                                                          std::span<const std::string> names,
                                                          KnownNames known) {
  const auto is_known = [&](const std::string& name) {
    return place_among(known, name).has_value();
  };
  if (std::ranges::none_of(names, is_known)) {
    require_commas(place, names, known);
    return std::nullopt;
  }
  std::vector<std::size_t> places;
  for (const std::string& name : names) {
    const auto found = place_among(known, name);
    if (!found) refuse_unknown(place, places.size(), name, known);
    if (std::ranges::find(places, *found) != places.end()) {
      throw InputError(
          fmt::format("{}: column '{}' appears twice; remove one", place, known[*found]));
    }
    places.push_back(*found);
  }
  return places;
}

}  // namespace beambench::rays
