#include "scenes/base/parameters.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/base/comma_list.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/nearest_name.hpp"
#include "scenes/base/printable.hpp"

namespace beambench {
namespace {

using Type = ParameterInfo::Type;
using Given = std::pair<std::string, std::string>;

// Numbers are stored as doubles, which represent integers up to this one exactly.
constexpr double kLargestInteger = 0x1p53;

/// Parses the whole text as a number; returns nothing on failure.
template <typename Number>
std::optional<Number> parse_number(std::string_view text) {
  Number number{};
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && rest == end ? std::optional(number) : std::nullopt;
}

std::optional<bool> parse_flag(std::string_view text) {
  if (text == "true" || text == "on" || text == "yes" || text == "1") return true;
  if (text == "false" || text == "off" || text == "no" || text == "0") return false;
  return std::nullopt;
}

constexpr std::string_view kAuto = "auto";

/// Parses one number for all axes, or three numbers separated by x.
std::optional<std::array<std::int32_t, 3>> parse_cells(std::string_view text) {
  std::array<std::int32_t, 3> cells{};
  std::size_t count = 0;
  while (true) {
    const std::size_t end = std::min(text.find('x'), text.size());
    const auto number = parse_number<std::int32_t>(text.substr(0, end));
    if (!number || count == cells.size()) return std::nullopt;
    cells[count++] = *number;
    if (end == text.size()) break;
    text.remove_prefix(end + 1);
  }
  if (count == 1) cells.fill(cells[0]);
  return count == 2 ? std::nullopt : std::optional(cells);
}

std::string cells_text(const std::array<std::int32_t, 3>& cells) {
  const bool equal = cells[0] == cells[1] && cells[1] == cells[2];
  return equal ? fmt::format("{}", cells[0]) : fmt::format("{}", fmt::join(cells, "x"));
}

/// A parsed value: its canonical text and its number.
struct Parsed {
  std::string text;
  double number;
};

std::optional<Parsed> parse_value(const ParameterInfo& info, const std::string& text) {
  const auto in_range = [&](double number) {
    return number >= info.minimum && number <= info.maximum;  // false for NaN
  };
  switch (info.type) {
    case Type::kIntegerOrAuto:
      if (text == kAuto) return Parsed{text, 0.0};
      [[fallthrough]];
    case Type::kInteger:
      if (const auto number = parse_number<std::int64_t>(text)) {
        const auto real = static_cast<double>(*number);
        if (in_range(real)) return Parsed{fmt::format("{}", *number), real};
      }
      break;
    case Type::kReal:
      if (const auto number = parse_number<double>(text)) {
        if (in_range(*number)) return Parsed{fmt::format("{}", *number), *number};
      }
      break;
    case Type::kFlag:
      if (const auto flag = parse_flag(text)) {
        return Parsed{*flag ? "true" : "false", *flag ? 1.0 : 0.0};
      }
      break;
    case Type::kChoice:
      if (std::find(info.choices.begin(), info.choices.end(), text) != info.choices.end()) {
        return Parsed{text, 0.0};
      }
      break;
    case Type::kCells:
      if (text == kAuto) return Parsed{text, 0.0};
      if (const auto cells = parse_cells(text)) {
        if (std::all_of(cells->begin(), cells->end(), in_range)) {
          return Parsed{cells_text(*cells), 0.0};
        }
      }
      break;
  }
  return std::nullopt;
}

std::string expectation(const ParameterInfo& info) {
  switch (info.type) {
    case Type::kInteger:
      return fmt::format("an integer from {:.0f} to {:.0f}", info.minimum, info.maximum);
    case Type::kIntegerOrAuto:
      return fmt::format("{}, or an integer from {:.0f} to {:.0f}", kAuto, info.minimum,
                         info.maximum);
    case Type::kReal:
      return fmt::format("a number from {} to {}", info.minimum, info.maximum);
    case Type::kFlag:
      return "true or false";
    case Type::kCells:
      return fmt::format("{}, a number of cells from {:.0f} to {:.0f}, or three such as 64x32x16",
                         kAuto, info.minimum, info.maximum);
    case Type::kChoice:
      break;
  }
  return fmt::format("one of {}", fmt::join(info.choices, ", "));
}

[[noreturn]] void refuse_value(const std::string& owner, const ParameterInfo& info,
                               const std::string& value) {
  throw InputError(fmt::format("{}: parameter {} is '{}', but must be {}", owner, info.name,
                               excerpt(value), expectation(info)));
}

[[noreturn]] void refuse_name(const std::string& owner, std::span<const ParameterInfo> infos,
                              const std::string& name) {
  if (infos.empty()) {
    throw InputError(
        fmt::format("{}: there is no parameter '{}'; {} takes none", owner, excerpt(name), owner));
  }
  std::vector<std::string> names;
  for (const ParameterInfo& info : infos) names.push_back(info.name);
  throw InputError(fmt::format("{}: there is no parameter '{}'; {}the valid ones are {}", owner,
                               excerpt(name), did_you_mean(name, names), fmt::join(names, ", ")));
}

ParameterInfo plain_info(std::string name, Type type, std::string default_value,
                         std::string description) {
  ParameterInfo info;
  info.name = std::move(name);
  info.type = type;
  info.default_value = std::move(default_value);
  info.description = std::move(description);
  return info;
}

[[noreturn]] void refuse(std::string_view text, std::string_view why) {
  throw InputError(
      fmt::format("'{}': {}; write a name, or name:key=value,key=value", excerpt(text), why));
}

/// Removes everything up to the first comma from the front of `text`, and returns it without the
/// comma.
std::string_view take_piece(std::string_view& text) {
  const std::size_t comma = std::min(text.find(','), text.size());
  const std::string_view piece = text.substr(0, comma);
  text.remove_prefix(std::min(comma + 1, text.size()));
  return piece;
}

/// Returns whether a piece between commas continues the spec with another `key=value`.
bool continues_spec(std::string_view piece) {
  return piece.find('=') < piece.find(':');  // npos (not found) is the largest number
}

}  // namespace

ParameterInfo integer_parameter(std::string name, std::int64_t default_value, std::int64_t minimum,
                                std::int64_t maximum, std::string description) {
  ParameterInfo info = plain_info(std::move(name), Type::kInteger, fmt::format("{}", default_value),
                                  std::move(description));
  info.minimum = static_cast<double>(minimum);
  info.maximum = static_cast<double>(maximum);
  if (info.minimum < -kLargestInteger || info.maximum > kLargestInteger) {
    throw std::logic_error("parameter " + info.name + " has a range beyond +-2^53");
  }
  return info;
}

ParameterInfo integer_or_auto_parameter(std::string name, std::int64_t default_value,
                                        std::int64_t minimum, std::int64_t maximum,
                                        std::string description) {
  ParameterInfo info =
      integer_parameter(std::move(name), default_value, minimum, maximum, std::move(description));
  info.type = Type::kIntegerOrAuto;
  return info;
}

ParameterInfo real_parameter(std::string name, double default_value, double minimum, double maximum,
                             std::string description) {
  ParameterInfo info = plain_info(std::move(name), Type::kReal, fmt::format("{}", default_value),
                                  std::move(description));
  info.minimum = minimum;
  info.maximum = maximum;
  return info;
}

ParameterInfo flag_parameter(std::string name, bool default_value, std::string description) {
  return plain_info(std::move(name), Type::kFlag, default_value ? "true" : "false",
                    std::move(description));
}

ParameterInfo choice_parameter(std::string name, std::string default_value,
                               std::vector<std::string> choices, std::string description) {
  ParameterInfo info =
      plain_info(std::move(name), Type::kChoice, std::move(default_value), std::move(description));
  info.choices = std::move(choices);
  return info;
}

ParameterInfo cells_parameter(std::string name, std::string default_value, std::int64_t maximum,
                              std::string description) {
  ParameterInfo info =
      plain_info(std::move(name), Type::kCells, std::move(default_value), std::move(description));
  info.minimum = 1.0;
  info.maximum = static_cast<double>(maximum);
  return info;
}

Parameters::Parameters(std::string owner, std::span<const ParameterInfo> infos,
                       std::span<const Given> given)
    : owner_(std::move(owner)) {
  values_.reserve(infos.size());
  for (const ParameterInfo& info : infos) {
    const auto parsed = parse_value(info, info.default_value);
    if (!parsed) {
      throw std::logic_error(owner_ + ": the default of parameter " + info.name + " is not valid");
    }
    values_.push_back({info, parsed->text, parsed->number});
  }
  for (const Given& pair : given) {
    const std::string& name = pair.first;
    const std::string& text = pair.second;
    const auto value = std::find_if(values_.begin(), values_.end(),
                                    [&](const Value& v) { return v.info.name == name; });
    if (value == values_.end()) refuse_name(owner_, infos, name);
    const auto parsed = parse_value(value->info, text);
    if (!parsed) refuse_value(owner_, value->info, text);
    value->text = parsed->text;
    value->number = parsed->number;
    value->given = true;
  }
}

const Parameters::Value& Parameters::find(std::string_view name, Type type) const {
  for (const Value& value : values_) {
    if (value.info.name == name && value.info.type == type) {
      value.read = true;
      return value;
    }
  }
  throw std::logic_error(
      fmt::format("{} reads a parameter {} that it did not declare with this type", owner_, name));
}

std::int64_t Parameters::integer(std::string_view name) const {
  return static_cast<std::int64_t>(find(name, Type::kInteger).number);
}

std::optional<std::int64_t> Parameters::integer_or_auto(std::string_view name) const {
  const Value& value = find(name, Type::kIntegerOrAuto);
  if (value.text == kAuto) return std::nullopt;
  return static_cast<std::int64_t>(value.number);
}

double Parameters::real(std::string_view name) const { return find(name, Type::kReal).number; }

bool Parameters::flag(std::string_view name) const { return find(name, Type::kFlag).number != 0.0; }

const std::string& Parameters::choice(std::string_view name) const {
  return find(name, Type::kChoice).text;
}

std::optional<std::array<std::int32_t, 3>> Parameters::cells(std::string_view name) const {
  return parse_cells(find(name, Type::kCells).text);  // nothing for `auto`
}

void Parameters::require_given_were_read() const {
  for (const Value& value : values_) {
    if (value.given && !value.read) {
      throw std::logic_error(owner_ + " declares the parameter " + value.info.name +
                             " and never reads it");
    }
  }
}

std::string Parameters::canonical() const {
  std::string text;
  for (const Value& value : values_) {
    if (!text.empty()) text += ',';
    text += value.info.name + '=' + value.text;
  }
  return text;
}

std::string Parameters::label() const {
  return values_.empty() ? owner_ : owner_ + ':' + canonical();
}

std::string Parameters::short_label() const {
  std::string text = owner_;
  for (const Value& value : values_) {
    if (value.text == value.info.default_value) continue;
    text += (text.size() == owner_.size() ? ':' : ',') + value.info.name + '=' + value.text;
  }
  return text;
}

std::vector<Given> Parameters::values() const {
  std::vector<Given> pairs;
  for (const Value& value : values_) pairs.emplace_back(value.info.name, value.text);
  return pairs;
}

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
      refuse(text, fmt::format("'{}' is not of the form key=value", excerpt(piece)));
    }
    const std::string_view key = piece.substr(0, equals);
    for (const auto& parameter : spec.parameters) {
      if (parameter.first == key) refuse(text, fmt::format("'{}' is given twice", excerpt(key)));
    }
    spec.parameters.emplace_back(key, piece.substr(equals + 1));
  }
  return spec;
}

std::vector<Spec> parse_spec_list(std::string_view text) {
  const std::string list = without_blanks_at_commas(text);
  text = list;
  if (text.ends_with(',')) refuse(text, "a name is missing after the last comma");
  std::vector<Spec> specs;
  std::string_view rest = text;
  std::size_t start = 0;  // start of the spec being collected
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
