#pragma once
// Numbers as texts write them.

#include <cstdint>
#include <optional>
#include <string_view>

namespace beambench {

/// Returns the number nearest to a decimal one, rounded once: by way of double, 7.038531e-26 would
/// become another float. Nothing where the word is anything else. A sign of either kind, `nan`,
/// `inf` and an exponent are part of a number; a comma is not. What is larger than every number of
/// the type becomes infinite, as IEEE 754 rounds it. Float and double.
template <typename Number>
std::optional<Number> number_of(std::string_view word);

extern template std::optional<float> number_of<float>(std::string_view word);
extern template std::optional<double> number_of<double>(std::string_view word);

/// Returns a whole number that is written without point and exponent, and fits.
std::optional<std::int64_t> integer_of(std::string_view word);

}  // namespace beambench
