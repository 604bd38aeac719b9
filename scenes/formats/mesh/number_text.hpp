#pragma once
// Numbers as texts write them.

#include <cstdint>
#include <optional>
#include <string_view>

namespace beambench::scenes::mesh {

/// Returns the float nearest to a decimal number, rounded once; nothing where the word is anything
/// else. A sign of either kind, `nan`, `inf` and an exponent are part of a number; a comma is not.
/// What is larger than every float becomes infinite, as IEEE 754 rounds it.
std::optional<float> float_of(std::string_view word);
/// Returns the same in double precision.
std::optional<double> double_of(std::string_view word);
/// Returns a whole number that is written without point and exponent, and fits.
std::optional<std::int64_t> integer_of(std::string_view word);

}  // namespace beambench::scenes::mesh
