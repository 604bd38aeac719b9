#include "harness/verify/selftest/subject.hpp"

#include <algorithm>
#include <exception>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "harness/verify/selftest/test_scenes.hpp"
#include "scenes/base/error.hpp"

namespace beambench::verify {
namespace {

/// Returns whether the structure refuses the scene; other faults are reported by the checks.
bool refuses(const accel::StructureChoice& choice, const scenes::Scene& scene) {
  try {
    choice.build(scene);
  } catch (const InputError&) {
    return true;
  } catch (const std::exception&) {
  }
  return false;
}

/// Returns whether the parameter is a cap, which limits a number of things; reaching it requires a
/// different test.
bool is_cap(const ParameterInfo& parameter) {
  constexpr double kSmallDefault = 1e3;
  constexpr double kSmallMaximum = 1e6;
  return parameter.default_value == "auto" ? parameter.maximum > kSmallMaximum
                                           : std::stod(parameter.default_value) > kSmallDefault;
}

std::string small_integer(const ParameterInfo& parameter, Random& random) {
  const auto low = static_cast<std::uint64_t>(parameter.minimum);
  const auto high = static_cast<std::uint64_t>(parameter.maximum);
  return std::to_string(std::min(low + random.below(9), high));
}

/// Returns a value to try; empty for the default.
std::string random_value(const ParameterInfo& parameter, Random& random) {
  using Type = ParameterInfo::Type;
  if (parameter.changes_hits) return "";
  switch (parameter.type) {
    case Type::kIntegerOrAuto:
      if (random.below(4) == 0) return "auto";
      [[fallthrough]];
    case Type::kInteger:
      return is_cap(parameter) ? "" : small_integer(parameter, random);
    case Type::kFlag:
      return random.below(2) == 0 ? "false" : "true";
    case Type::kChoice:
      return parameter.choices[random.below(parameter.choices.size())];
    case Type::kCells:
      if (random.below(4) == 0) return "";
      return fmt::format("{}x{}x{}", 1 + random.below(20), 1 + random.below(20),
                         1 + random.below(20));
    case Type::kReal:
      break;
  }
  return "";
}

}  // namespace

bool PrimitiveKinds::include(scenes::PrimitiveKind kind) const {
  switch (kind) {
    case scenes::PrimitiveKind::kSphere:
      return spheres;
    case scenes::PrimitiveKind::kCone:
      return cones;
    case scenes::PrimitiveKind::kPolygon:
      break;
  }
  return polygons;
}

bool PrimitiveKinds::include(const scenes::Scene& scene) const {
  return (spheres || scene.spheres.empty()) && (cones || scene.cones.empty()) &&
         (polygons || scene.polygons.empty());
}

std::vector<std::string_view> PrimitiveKinds::names() const {
  std::vector<std::string_view> names;
  if (spheres) names.push_back("spheres");
  if (cones) names.push_back("cones");
  if (polygons) names.push_back("polygons");
  return names;
}

PrimitiveKinds kinds_taken(const accel::StructureChoice& choice) {
  PrimitiveKinds kinds;
  for (const scenes::Scene& scene : smallest_scenes()) {
    if (scene.primitives.empty() || !refuses(choice, scene)) continue;
    if (!scene.spheres.empty()) kinds.spheres = false;
    if (!scene.cones.empty()) kinds.cones = false;
    if (!scene.polygons.empty()) kinds.polygons = false;
  }
  return kinds.none() ? PrimitiveKinds{} : kinds;
}

Parameters random_parameters(const accel::StructureInfo& info, Random& random) {
  std::vector<std::pair<std::string, std::string>> given;
  for (const ParameterInfo& parameter : info.parameters) {
    std::string value = random_value(parameter, random);
    if (!value.empty()) given.emplace_back(parameter.name, std::move(value));
  }
  return {info.name, info.parameters, given};
}

accel::StructureChoice Subject::vary(Random& random) const {
  if (choice_.short_label() != info().name) return choice_;
  return {info(), random_parameters(info(), random)};
}

}  // namespace beambench::verify
