#include "scenes/formats/mesh/text_lines.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "scenes/base/error.hpp"

namespace beambench::scenes::mesh {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// Returns C's isspace: CR is a blank if lines end with LF, and vice versa.
bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

char end_of_first_line(std::string_view text) {
  const std::size_t at = text.find_first_of("\r\n");
  if (at == std::string_view::npos || text[at] == '\n') return '\n';
  return text.substr(at + 1).starts_with('\n') ? '\n' : '\r';
}

}  // namespace

TextLines::TextLines(std::string_view text, char comment) : rest_(text), comment_(comment) {
  if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
  end_ = end_of_first_line(rest_);
}

bool TextLines::next() {
  line_ = {};
  if (rest_.empty()) return false;
  line_ = rest_.substr(0, rest_.find(end_));
  rest_.remove_prefix(std::min(line_.size() + 1, rest_.size()));
  ++number_;
  if (comment_ != '\0') line_ = line_.substr(0, line_.find(comment_));
  return true;
}

bool TextLines::next_with_words() {
  while (next()) {
    if (!std::all_of(line_.begin(), line_.end(), is_blank)) return true;
  }
  return false;
}

std::string_view TextLines::word() {
  const auto* const begin = std::find_if_not(line_.begin(), line_.end(), is_blank);
  const auto* const end = std::find_if(begin, line_.end(), is_blank);
  const std::string_view word(begin, static_cast<std::size_t>(end - begin));
  line_.remove_prefix(static_cast<std::size_t>(end - line_.begin()));
  return word;
}

std::string_view TextLines::word_anywhere() {
  for (;;) {
    const std::string_view found = word();
    if (!found.empty() || !next()) return found;
  }
}

void TextLines::refuse(std::string_view why) const {
  throw InputError(
      fmt::format("line {}: {}; export it again", std::max<std::size_t>(number_, 1), why));
}

std::string counted(std::size_t count, std::string_view one, std::string_view several) {
  return fmt::format("{} {}", count, count == 1 ? one : several);
}

}  // namespace beambench::scenes::mesh
