#pragma once
// Parses numbers in text.

#include <cstdint>
#include <optional>
#include <string_view>

namespace beambench {

/// Returns the nearest representable number, rounded once: going through double would turn
/// 7.038531e-26 into a different float. Returns nothing if the word is not a number. Either sign,
/// `nan`, `inf` and an exponent are part of a number; a comma is not. Numbers too large for the
/// type become infinite, as IEEE 754 rounds them. `Number` is float or double.
template <typename Number>
std::optional<Number> number_of(std::string_view word);

extern template std::optional<float> number_of<float>(std::string_view word);
extern template std::optional<double> number_of<double>(std::string_view word);

/// Returns the whole number if the word has no point or exponent and the number fits.
std::optional<std::int64_t> integer_of(std::string_view word);

}  // namespace beambench
