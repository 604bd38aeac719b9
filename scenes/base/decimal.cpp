#include "scenes/base/decimal.hpp"

#include <charconv>
#include <system_error>

#include <fast_float/fast_float.h>

namespace beambench {
namespace {

/// Removes a plus sign, which neither fast_float nor std::from_chars accepts; "+-1" stays invalid.
std::string_view without_plus(std::string_view word) {
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  return word;
}

}  // namespace

template <typename Number>
std::optional<Number> number_of(std::string_view word) {
  word = without_plus(word);
  Number number = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = fast_float::from_chars(word.data(), end, number);
  // Newer versions report out-of-range numbers as errors, but return the same value.
  if (error != std::errc() && error != std::errc::result_out_of_range) return std::nullopt;
  if (stop != end || word.empty()) return std::nullopt;
  return number;
}

template std::optional<float> number_of<float>(std::string_view word);
template std::optional<double> number_of<double>(std::string_view word);

std::optional<std::int64_t> integer_of(std::string_view word) {
  word = without_plus(word);
  std::int64_t number = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, number);
  if (error != std::errc() || stop != end || word.empty()) return std::nullopt;
  return number;
}

}  // namespace beambench
