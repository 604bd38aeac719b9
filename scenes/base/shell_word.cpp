#include "scenes/base/shell_word.hpp"

#include <algorithm>
#include <cctype>

#include "scenes/base/printable.hpp"

namespace beambench {
namespace {

bool is_plain(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
         std::string_view("_-+.,:=/@%").find(c) != std::string_view::npos;
}

}  // namespace

std::string shell_quoted(std::string_view word) {
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return std::string(word);
  const bool is_printable = printable(word) == word;
  std::string quoted = is_printable ? "'" : "$'";
  const std::string_view apostrophe = is_printable ? "'\\''" : "\\'";
  for (const char c : is_printable ? std::string(word) : name_of_path(word)) {
    if (c == '\'') {
      quoted += apostrophe;
    } else {
      quoted += c;
    }
  }
  return quoted + '\'';
}

}  // namespace beambench
