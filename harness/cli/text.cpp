#include "harness/cli/text.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/base/messages.hpp"

namespace beambench::cli {

TextTable::TextTable(std::vector<std::string> header, std::size_t left_columns)
    : left_columns_(left_columns), rows_{std::move(header)} {}

void TextTable::add(std::vector<std::string> row) {
  if (row.size() != rows_.front().size())
    throw std::logic_error("a row of a table has missing cells");
  rows_.push_back(std::move(row));
}

std::string TextTable::text() const {
  std::vector<std::string> lines = base::aligned(rows_, left_columns_);
  const std::size_t width = std::ranges::max(lines, {}, &std::string::size).size();
  lines.insert(lines.begin() + 1, std::string(width, '-'));
  return fmt::format("{}\n", fmt::join(lines, "\n"));
}

std::string wrap(std::string_view text, std::size_t indent, std::size_t width) {
  const std::string margin(indent, ' ');
  std::string out;
  std::string line;
  const auto flush = [&] {
    if (!line.empty()) out += margin + line + '\n';
    line.clear();
  };
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!line.empty() && indent + line.size() + 1 + word.size() > width) flush();
    if (!line.empty() && !word.empty()) line += ' ';
    line += word;
  }
  flush();
  return out;
}

std::string format_bytes(std::uint64_t bytes) {
  const auto size = static_cast<double>(bytes);
  if (size < 1e3) return fmt::format("{} bytes", bytes);
  if (size < 1e6) return fmt::format("{:.2f} kB", size / 1e3);
  if (size < 1e9) return fmt::format("{:.2f} MB", size / 1e6);
  return fmt::format("{:.2f} GB", size / 1e9);
}

std::string format_share(std::uint64_t part, std::uint64_t whole) {
  if (whole == 0) return "-";
  return fmt::format("{:.1f}%", 100.0 * static_cast<double>(part) / static_cast<double>(whole));
}

}  // namespace beambench::cli
