#include "scenes/formats/mesh/obj_lines.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/base/printable.hpp"

namespace beambench::scenes::mesh {
namespace {

constexpr std::string_view kLineBlanks = " \t";

}  // namespace

std::string_view take_line(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find_first_of("\r\n"));
  text.remove_prefix(line.size());
  if (text.starts_with("\r\n")) text.remove_prefix(1);
  if (!text.empty()) text.remove_prefix(1);
  return line;
}

std::string_view take_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(kLineBlanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kLineBlanks));
  line.remove_prefix(word.size());
  return word;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kLineBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kLineBlanks) - first + 1);
}

std::string_view without_comment(std::string_view name) {
  return trimmed(name.substr(0, std::min(name.find(" #"), name.find("\t#"))));
}

void UnknownLines::add(std::size_t line, std::string_view word) {
  constexpr std::size_t kNamed = 3;
  ++count_;
  if (first_.size() < kNamed) first_.push_back(fmt::format("line {} ('{}')", line, excerpt(word)));
}

std::string UnknownLines::message() const {
  const std::size_t more = count_ - first_.size();
  return fmt::format("{} not understood and {} left out: {}{}",
                     count_ == 1 ? "1 line is" : fmt::format("{} lines are", count_),
                     count_ == 1 ? "was" : "were", fmt::join(first_, ", "),
                     more == 0 ? "" : fmt::format(" and {} more", more));
}

}  // namespace beambench::scenes::mesh
