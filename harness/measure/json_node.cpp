#include "harness/measure/json_node.hpp"

#include <fmt/format.h>

#include "scenes/base/json_text.hpp"

namespace beambench::measure {

using nlohmann::json;

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

std::optional<JsonNode> JsonNode::find(std::string_view key) const {
  const auto found = value_->find(std::string(key));
  if (found == value_->end()) return std::nullopt;
  return JsonNode(*found, file_, pointer_ / std::string(key));
}

std::vector<std::pair<std::string, JsonNode>> JsonNode::members() const {
  std::vector<std::pair<std::string, JsonNode>> list;
  for (const auto& [key, value] : value_->items()) {
    list.emplace_back(key, JsonNode(value, file_, pointer_ / key));
  }
  return list;
}

std::vector<JsonNode> JsonNode::elements() const {
  std::vector<JsonNode> list;
  for (std::size_t i = 0; i < value_->size(); ++i) {
    list.push_back(JsonNode((*value_)[i], file_, pointer_ / i));
  }
  return list;
}

std::string JsonNode::parameter_text() const {
  if (value_->is_string()) return value_->get<std::string>();
  if (value_->is_number_float()) return fmt::format("{}", value_->get<double>());
  return json_text(*value_, -1);
}

}  // namespace beambench::measure
