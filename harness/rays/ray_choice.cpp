#include "harness/rays/ray_choice.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/core/error.hpp"

namespace beambench::rays {
namespace {

bool has_seed(const RayKindInfo& info) {
  return std::ranges::find(info.parameters, "seed", &ParameterInfo::name) != info.parameters.end();
}

RayChoice choose(const Spec& spec) {
  const auto kinds = ray_kinds();
  const auto info = std::ranges::find(kinds, spec.name, &RayKindInfo::name);
  if (info == kinds.end()) {
    std::vector<std::string> names;
    for (const RayKindInfo& known : kinds) names.push_back(known.name);
    throw InputError(
        fmt::format("unknown ray kind '{}'; choose from: {}, or a file of saved rays (*{})",
                    spec.name, fmt::join(names, ", "), kRayFileEnding));
  }
  const Parameters parameters(info->name, info->parameters, spec.parameters);
  RayChoice choice{info->kind, 0, {}, parameters.short_label()};
  if (has_seed(*info)) choice.seed = static_cast<std::uint64_t>(parameters.integer("seed"));
  return choice;
}

/// Does a list go on with another parameter, `name=value`, of the choice before?
bool is_parameter(std::string_view rest) {
  const std::size_t end = rest.find_first_of(",:=");
  return end != std::string_view::npos && rest[end] == '=';
}

RayChoice choose_file(std::string_view path) {
  RayChoice choice;
  choice.file = path;
  choice.label = path;
  return choice;
}

}  // namespace

RayChoice parse_ray_choice(std::string_view text) {
  return text.ends_with(kRayFileEnding) ? choose_file(text) : choose(parse_spec(text));
}

std::vector<RayChoice> parse_ray_choices(std::string_view list) {
  std::vector<RayChoice> choices;
  for (std::size_t start = 0; start <= list.size();) {
    std::size_t comma = std::min(list.find(',', start), list.size());
    while (comma < list.size() && is_parameter(list.substr(comma + 1))) {
      comma = std::min(list.find(',', comma + 1), list.size());
    }
    RayChoice choice = parse_ray_choice(list.substr(start, comma - start));
    if (std::ranges::find(choices, choice) == choices.end()) choices.push_back(std::move(choice));
    start = comma + 1;
  }
  return choices;
}

}  // namespace beambench::rays
