#include "scenes/formats/nff/nff_tokens.hpp"

#include <cmath>

#include <fmt/format.h>

#include "scenes/base/decimal.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/printable.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::nff {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

NffTokens::NffTokens(std::string_view text, std::string_view file)
    : file_(printable(file)), position_(text.data()), end_(text.data() + text.size()) {
  token_.starts_line = true;  // for the empty token before the first one
  advance();
}

void NffTokens::advance() {
  bool starts_line = position_ == end_ || token_.text.empty();
  for (; position_ != end_; ++position_) {
    if (starts_line && at_own_comment()) position_ += kOwnComment.size();
    if (*position_ == '#') {
      while (position_ != end_ && !at_line_end()) ++position_;
      if (position_ == end_) break;
    }
    if (!is_blank(*position_)) break;
    if (at_line_end()) {
      ++token_.line;
      starts_line = true;
    }
  }
  const char* start = position_;
  while (position_ != end_ && !is_blank(*position_) && *position_ != '#') ++position_;
  token_.text = std::string_view(start, static_cast<std::size_t>(position_ - start));
  token_.starts_line = starts_line;
}

bool NffTokens::at_line_end() const {
  if (*position_ == '\n') return true;
  return *position_ == '\r' && (position_ + 1 == end_ || position_[1] != '\n');
}

bool NffTokens::at_own_comment() const {
  const std::string_view rest(position_, static_cast<std::size_t>(end_ - position_));
  return rest.starts_with(kOwnComment) && rest.size() > kOwnComment.size() &&
         is_blank(rest[kOwnComment.size()]);
}

NffToken NffTokens::take() {
  const NffToken taken = token_;
  advance();
  return taken;
}

bool NffTokens::at_number() const {
  if (at_end()) return false;
  const std::string_view text = token_.text;
  const std::size_t sign = text[0] == '-' || text[0] == '+' ? 1 : 0;
  const std::string_view rest = text.substr(sign);
  return !rest.empty() && (is_digit(rest[0]) || rest[0] == '.' || rest == "nan" || rest == "inf");
}

std::size_t NffTokens::max_numbers_left() const {
  const auto bytes = static_cast<std::size_t>(end_ - position_) + token_.text.size();
  return (bytes + 1) / 2;  // a number takes at least a digit and a blank
}

template <typename Number>
Number NffTokens::take_number(std::string_view what) {
  if (at_end()) refuse(token_.line, fmt::format("the file ends where {} should be", what));
  const auto number = number_of<Number>(token_.text);
  if (!number || !(std::abs(*number) <= static_cast<Number>(kLargestNumber))) {
    refuse(token_.line, fmt::format("found '{}' where {} should be a number from -1e9 to 1e9",
                                    excerpt(token_.text), what));
  }
  advance();
  return *number;
}

float NffTokens::number(std::string_view what) { return take_number<float>(what); }

glm::vec3 NffTokens::triple(std::string_view what) {
  const float x = number(what);
  const float y = number(what);
  const float z = number(what);
  return {x, y, z};
}

long NffTokens::integer(std::string_view what) {
  const NffToken token = token_;
  const auto real = take_number<double>(what);
  if (real != std::floor(real)) {
    refuse(token.line,
           fmt::format("found '{}' where {} should be an integer", excerpt(token.text), what));
  }
  return static_cast<long>(real);
}

std::string_view NffTokens::rest_of_line(const NffToken& word, std::string_view what) {
  if (at_end() || token_.line != word.line) {
    refuse(word.line, fmt::format("{} should follow '{}' on its line", what, word.text));
  }
  const char* start = token_.text.data();
  while (position_ != end_ && !at_line_end() && *position_ != '#') ++position_;
  std::string_view rest(start, static_cast<std::size_t>(position_ - start));
  while (is_blank(rest.back())) rest.remove_suffix(1);
  advance();
  return rest;
}

std::string NffTokens::located(std::size_t line, std::string_view message) const {
  return fmt::format("{}:{}: {}", file_, line, message);
}

void NffTokens::refuse(std::size_t line, std::string_view message) const {
  throw InputError(located(line, message));
}

}  // namespace beambench::scenes::nff
