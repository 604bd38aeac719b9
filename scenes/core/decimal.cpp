#include "scenes/core/decimal.hpp"

#include <charconv>
#include <limits>
#include <system_error>

namespace beambench {
namespace {

/// Whether a number that no float or double can hold is too small for them, not too large.
bool too_small(std::string_view word) {
  const std::size_t exponent = word.find_first_of("eE");
  if (exponent != std::string_view::npos) return word.substr(exponent + 1).starts_with('-');
  const std::size_t first = word.find_first_not_of("-0");
  return first != std::string_view::npos && word[first] == '.';
}

}  // namespace

template <typename Number>
Number decimal_number(std::string_view word) {
  constexpr Number kNone = std::numeric_limits<Number>::quiet_NaN();
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  const char* end = word.data() + word.size();
  Number number = kNone;
  const auto [rest, error] = std::from_chars(word.data(), end, number);
  if (rest != end) return kNone;
  if (error == std::errc::result_out_of_range) return too_small(word) ? Number{0} : kNone;
  return error == std::errc() ? number : kNone;
}

template float decimal_number<float>(std::string_view word);
template double decimal_number<double>(std::string_view word);

}  // namespace beambench
