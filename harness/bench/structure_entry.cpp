#include "harness/bench/structure_entry.hpp"

#include <fmt/format.h>

namespace beambench::bench {
namespace {

/// A parameter and the values it takes in turn.
struct SweptParameter {
  std::string name;
  std::vector<std::string> values;
};

SweptParameter read_parameter(const std::string& structure, const std::string& name,
                              const JsonNode& node, const accel::Registry& structures) {
  const std::vector<JsonNode> nodes =
      node.value().is_array() ? node.elements() : std::vector<JsonNode>{node};
  SweptParameter parameter{name, {}};
  for (const JsonNode& value : nodes) {
    const std::string text = value.parameter_text();
    // Chosen alone for the sake of the message: parameters are checked independently.
    value.checked([&] { return structures.choose({structure, {{name, text}}}); });
    parameter.values.push_back(text);
  }
  return parameter;
}

void require_affordable(const JsonNode& node, const std::vector<SweptParameter>& parameters) {
  constexpr std::size_t kMaxCombinations = 10'000;
  std::size_t combinations = 1;
  for (const SweptParameter& parameter : parameters) {
    combinations *= parameter.values.size();
    if (combinations > kMaxCombinations) {
      node.fail(
          fmt::format("the lists of parameters multiply to more than {} structures; shorten "
                      "them",
                      kMaxCombinations));
    }
  }
}

/// All combinations, as specs of `structure`.
std::vector<Spec> multiply_out(const std::string& structure,
                               const std::vector<SweptParameter>& parameters) {
  std::vector<Spec> specs{{structure, {}}};
  for (const SweptParameter& parameter : parameters) {
    std::vector<Spec> longer;
    for (const Spec& spec : specs) {
      for (const std::string& value : parameter.values) {
        longer.push_back(spec);
        longer.back().parameters.emplace_back(parameter.name, value);
      }
    }
    specs = std::move(longer);
  }
  return specs;
}

}  // namespace

std::vector<accel::StructureChoice> read_structure_entry(const JsonNode& node,
                                                         const accel::Registry& structures) {
  if (node.value().is_string()) {
    const std::string text = node.text();
    return node.checked([&] { return structures.choose_list(text); });
  }
  node.require_object({"structure", "parameters"});
  const JsonNode name_node = node.require("structure");
  const std::string name = name_node.text();
  name_node.checked([&] { return structures.choose({name, {}}); });
  std::vector<SweptParameter> parameters;
  if (const auto given = node.find("parameters")) {
    for (const auto& [key, value] : given->members()) {
      parameters.push_back(read_parameter(name, key, value, structures));
    }
  }
  require_affordable(node, parameters);
  std::vector<accel::StructureChoice> choices;
  for (const Spec& spec : multiply_out(name, parameters))
    choices.push_back(structures.choose(spec));
  return choices;
}

}  // namespace beambench::bench
