// Names with parameters as they are typed: parse_spec and parse_spec_list of parameters.hpp.

#include <algorithm>

#include <fmt/format.h>

#include "scenes/core/error.hpp"
#include "scenes/core/parameters.hpp"

namespace beambench {
namespace {

[[noreturn]] void refuse(std::string_view text, std::string_view why) {
  throw InputError(fmt::format("'{}': {}; write a name, or name:key=value,key=value", text, why));
}

/// Takes the text up to the first comma off the front of `text`, and the comma with it.
std::string_view take_piece(std::string_view& text) {
  const std::size_t comma = std::min(text.find(','), text.size());
  const std::string_view piece = text.substr(0, comma);
  text.remove_prefix(std::min(comma + 1, text.size()));
  return piece;
}

/// Whether a piece between commas is a further `key=value`, not the start of a spec.
bool continues_spec(std::string_view piece) {
  return piece.find('=') < piece.find(':');  // npos, when there is none, is the largest number
}

}  // namespace

Spec parse_spec(std::string_view text) {
  const std::size_t colon = text.find(':');
  Spec spec;
  spec.name = text.substr(0, colon);
  if (spec.name.empty()) refuse(text, "the name is missing");
  if (spec.name.find_first_of("=,") != std::string::npos) {
    refuse(text, "a colon is missing after the name");
  }
  if (colon == std::string_view::npos) return spec;

  std::string_view rest = text.substr(colon + 1);
  if (rest.empty() || rest.back() == ',') refuse(text, "a parameter is missing at the end");
  while (!rest.empty()) {
    const std::string_view piece = take_piece(rest);
    const std::size_t equals = piece.find('=');
    if (equals == std::string_view::npos || equals == 0 || equals + 1 == piece.size()) {
      refuse(text, fmt::format("'{}' is not of the form key=value", piece));
    }
    const std::string_view key = piece.substr(0, equals);
    for (const auto& parameter : spec.parameters) {
      if (parameter.first == key) refuse(text, fmt::format("'{}' is given twice", key));
    }
    spec.parameters.emplace_back(key, piece.substr(equals + 1));
  }
  return spec;
}

std::vector<Spec> parse_spec_list(std::string_view text) {
  if (text.ends_with(',')) refuse(text, "a name is missing after the last comma");
  std::vector<Spec> specs;
  std::string_view rest = text;
  std::size_t start = 0;  // of the spec being collected
  take_piece(rest);
  while (!rest.empty()) {
    const std::size_t at = text.size() - rest.size();
    if (!continues_spec(take_piece(rest))) {
      specs.push_back(parse_spec(text.substr(start, at - 1 - start)));
      start = at;
    }
  }
  specs.push_back(parse_spec(text.substr(start)));
  return specs;
}

}  // namespace beambench
