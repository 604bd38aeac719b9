#pragma once
// Decimal numbers of text files.

#include <string_view>

namespace beambench {

/// Returns the number that the whole word is, rounded once: by way of double, 7.038531e-26 would
/// become another float. 0 for a number that is too small for the type. NaN for a word that is not
/// a number, and for a number that is too large. `inf` and `nan` are numbers here.
template <typename Number>
Number decimal_number(std::string_view word);

extern template float decimal_number<float>(std::string_view word);
extern template double decimal_number<double>(std::string_view word);

}  // namespace beambench
