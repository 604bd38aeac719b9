#include "harness/measure/sweep_schema.hpp"

#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "harness/measure/json_node.hpp"
#include "harness/measure/sweep_schema_text.hpp"
#include "scenes/base/json_text.hpp"
#include "scenes/base/nearest_name.hpp"
#include "scenes/base/printable.hpp"

namespace beambench::measure {
namespace {

using nlohmann::json;

/// An invalid value, and the part of the schema that applies to it.
struct Fault {
  JsonNode value;
  const json* schema;
};

/// Follows the steps of a valijson error, such as {"<root>", "[scenes]", "[1]"}.
Fault find_fault(const JsonNode& root, const json& schema, const std::vector<std::string>& steps) {
  Fault fault{root, &schema};
  for (std::size_t i = 1; i < steps.size(); ++i) {
    const std::string name = steps[i].substr(1, steps[i].size() - 2);
    if (fault.value.value().is_array()) {
      fault = {fault.value.elements().at(std::stoul(name)), &fault.schema->at("items")};
    } else {
      const json& known = fault.schema->value("properties", json::object());
      fault = {*fault.value.find(name), known.contains(name)
                                            ? &fault.schema->at("properties").at(name)
                                            : &fault.schema->at("additionalProperties")};
    }
  }
  return fault;
}

/// Returns a value as shown in messages.
std::string shown(const json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return value.empty() ? "an empty list" : "a list";
  return excerpt(json_text(value, -1));
}

std::string range(const json& schema) {
  if (!schema.contains("minimum")) return "";
  if (!schema.contains("maximum")) return fmt::format(" from {} on", schema["minimum"].dump());
  return fmt::format(" from {} to {}", schema["minimum"].dump(), schema["maximum"].dump());
}

/// Describes what a schema expects of a value of the given type.
std::string describe(const std::string& type, const json& schema) {
  if (type == "object") return "an object";
  if (type == "array") return "a list with at least one element";
  if (type == "boolean") return "true or false";
  if (type == "integer") return fmt::format("a whole number{}", range(schema));
  if (type == "number") return fmt::format("a number{}", range(schema));
  return "a string";
}

bool has_type(const json& value, const std::string& type) {
  if (type == "object") return value.is_object();
  if (type == "array") return value.is_array();
  if (type == "boolean") return value.is_boolean();
  return type == "string" ? value.is_string() : value.is_number();
}

std::string expected(const json& schema, const json& value) {
  if (schema.contains("enum")) {
    return fmt::format("{}", fmt::join(schema["enum"].get<std::vector<std::string>>(), " or "));
  }
  const std::vector<std::string> types = schema.at("type").is_array()
                                             ? schema["type"].get<std::vector<std::string>>()
                                             : std::vector{schema["type"].get<std::string>()};
  std::vector<std::string> described;
  for (const std::string& type : types) {
    const bool fits = has_type(value, type);
    // The schema explains patterns and numbers of members in words.
    if (fits && (schema.contains("pattern") || schema.contains("minProperties"))) {
      return schema.at("description");
    }
    if (fits) return describe(type, schema);
    described.push_back(describe(type, schema));
  }
  return fmt::format("{}", fmt::join(described, " or "));
}

[[noreturn]] void report(const Fault& fault) {
  const auto& [node, schema] = fault;
  if (node.value().is_object()) {
    std::vector<std::string> known;
    const json properties = schema->value("properties", json::object());
    for (const auto& property : properties.items()) known.push_back(property.key());
    for (const auto& [key, member] : node.members()) {
      if (schema->value("additionalProperties", json()) != false || properties.contains(key)) {
        continue;
      }
      member.fail(fmt::format("unknown key; {}expected one of {}", did_you_mean(key, known),
                              fmt::join(known, ", ")));
    }
    for (const json& key : schema->value("required", json::array())) {
      if (node.find(key.get<std::string>())) continue;
      node.fail(fmt::format("the key '{}' is missing", key.get<std::string>()));
    }
  }
  node.fail(
      fmt::format("expected {}, found {}", expected(*schema, node.value()), shown(node.value())));
}

}  // namespace

void require_sweep_form(const json& document, const std::string& file) {
  using Adapter = valijson::adapters::NlohmannJsonAdapter;
  const json schema_text = json::parse(sweep_schema_text());
  valijson::Schema schema;
  valijson::SchemaParser().populateSchema(Adapter(schema_text), schema);
  // Numbers do not count as strings here, because the types are `strong`.
  valijson::Validator validator(valijson::Validator::kStrongTypes);
  valijson::ValidationResults results;
  if (validator.validate(schema, Adapter(document), &results)) return;
  report(find_fault(JsonNode(document, file), schema_text, results.begin()->context));
}

}  // namespace beambench::measure
