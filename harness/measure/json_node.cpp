#include "harness/measure/json_node.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/base/json_text.hpp"
#include "scenes/base/nearest_name.hpp"
#include "scenes/base/printable.hpp"

namespace beambench::measure {
namespace {

using nlohmann::json;

/// Returns a value as a message shows it.
std::string shown(const json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return value.empty() ? "an empty list" : "a list";
  return excerpt(json_text(value, -1));
}

}  // namespace

JsonNode::JsonNode(const json& document, std::string file)
    : JsonNode(document, std::move(file), json::json_pointer()) {}

JsonNode::JsonNode(const json& value, std::string file, json::json_pointer pointer)
    : value_(&value), file_(std::move(file)), pointer_(std::move(pointer)) {}

std::string JsonNode::place() const {
  return pointer_.empty() ? file_ : fmt::format("{}: {}", file_, pointer_.to_string());
}

void JsonNode::fail(std::string_view message) const {
  throw InputError(fmt::format("{}: {}", place(), message));
}

void JsonNode::fail_expecting(std::string_view expected) const {
  fail(fmt::format("expected {}, found {}", expected, shown(*value_)));
}

void JsonNode::require_object(std::initializer_list<std::string_view> known_keys) const {
  if (!value_->is_object()) fail_expecting("an object");
  const std::vector<std::string> known(known_keys.begin(), known_keys.end());
  for (const auto& [key, member] : members()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    member.fail(fmt::format("unknown key; {}expected one of {}", did_you_mean(key, known),
                            fmt::join(known, ", ")));
  }
}

std::optional<JsonNode> JsonNode::find(std::string_view key) const {
  const auto found = value_->find(std::string(key));
  if (found == value_->end()) return std::nullopt;
  return JsonNode(*found, file_, pointer_ / std::string(key));
}

JsonNode JsonNode::require(std::string_view key) const {
  if (auto member = find(key)) return *std::move(member);
  fail(fmt::format("the key '{}' is missing", key));
}

std::vector<std::pair<std::string, JsonNode>> JsonNode::members() const {
  if (!value_->is_object()) fail_expecting("an object");
  std::vector<std::pair<std::string, JsonNode>> list;
  for (const auto& [key, value] : value_->items()) {
    list.emplace_back(key, JsonNode(value, file_, pointer_ / key));
  }
  return list;
}

std::vector<JsonNode> JsonNode::elements() const {
  if (!value_->is_array() || value_->empty()) fail_expecting("a list with at least one element");
  std::vector<JsonNode> list;
  for (std::size_t i = 0; i < value_->size(); ++i) {
    list.push_back(JsonNode((*value_)[i], file_, pointer_ / i));
  }
  return list;
}

std::string JsonNode::text() const {
  if (!value_->is_string()) fail_expecting("a string");
  return value_->get<std::string>();
}

std::int64_t JsonNode::integer(std::int64_t minimum, std::int64_t maximum) const {
  const std::string expected = fmt::format("a whole number from {} to {}", minimum, maximum);
  if (!value_->is_number_integer()) fail_expecting(expected);
  // A number beyond 2^63 - 1 is stored as unsigned and would wrap.
  const bool huge = value_->is_number_unsigned() && value_->get<std::uint64_t>() > INT64_MAX;
  const auto number = value_->get<std::int64_t>();
  if (huge || number < minimum || number > maximum) fail_expecting(expected);
  return number;
}

double JsonNode::number(double minimum, double maximum) const {
  const std::string expected = fmt::format("a number from {} to {}", minimum, maximum);
  if (!value_->is_number()) fail_expecting(expected);
  const auto number = value_->get<double>();
  if (!(number >= minimum && number <= maximum)) fail_expecting(expected);
  return number;
}

std::string JsonNode::parameter_text() const {
  if (value_->is_string()) return value_->get<std::string>();
  if (value_->is_number_float()) return fmt::format("{}", value_->get<double>());
  if (value_->is_number_integer() || value_->is_boolean()) return json_text(*value_, -1);
  fail_expecting("a number, a string, true or false");
}

}  // namespace beambench::measure
