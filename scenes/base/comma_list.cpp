#include "scenes/base/comma_list.hpp"

#include <algorithm>

namespace beambench {

std::string without_blanks_at_commas(std::string_view list) {
  constexpr std::string_view kBlanks = " \t\n";
  std::string out;
  while (true) {
    const std::size_t comma = std::min(list.find(','), list.size());
    std::string_view piece = list.substr(0, comma);
    piece.remove_prefix(std::min(piece.find_first_not_of(kBlanks), piece.size()));
    out += piece.substr(0, piece.find_last_not_of(kBlanks) + 1);
    if (comma == list.size()) return out;
    out += ',';
    list.remove_prefix(comma + 1);
  }
}

}  // namespace beambench
