#include "accel/core/registry.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "accel/core/build_memory.hpp"
#include "accel/core/moved_structure.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/nearest_name.hpp"
#include "scenes/base/printable.hpp"

namespace beambench::accel {

// Defined by the build from its list of families (register_families.cpp.in).
void register_families(Registry& registry);

std::unique_ptr<Accelerator> StructureChoice::build(const scenes::Scene& scene,
                                                    const Workload& workload) const {
  if (!info_->support.includes(scene)) {
    throw UnsupportedError(fmt::format("'{}' does not support all kinds of primitives in {}",
                                       info_->name, scene.name));
  }
  require_build_memory(*this, scene, workload);
  std::unique_ptr<Accelerator> accelerator;
  if (updates()) {
    auto moved = std::make_unique<MovedStructure>(*this, scene, copy_first_frame(scene), workload);
    moved->place();
    moved->update();
    accelerator = std::move(moved);
  } else {
    accelerator = info_->build(scene, parameters_, workload);
  }
  parameters_.require_given_were_read();
  return accelerator;
}

std::unique_ptr<Accelerator> StructureChoice::build(const scenes::Scene& scene) const {
  return build(scene, usual_workload(scene));
}

bool StructureChoice::updates() const {
  const ParameterInfo update = update_parameter();
  return std::ranges::find(info_->parameters, update.name, &ParameterInfo::name) !=
             info_->parameters.end() &&
         parameters_.flag(update.name);
}

ParameterInfo update_parameter() {
  return flag_parameter("update", false,
                        "for moving scenes: build over the first frame and update to the current "
                        "one instead of rebuilding");
}

std::span<const CounterInfo> common_counters() {
  static const auto all = std::to_array<CounterInfo>({
      {"traversal_steps", "cells or nodes entered by a ray, leaves included"},
      {"leaves", "leaves entered, empty ones included"},
      {"empty_leaves", "leaves entered that hold no reference"},
      {"box_tests", "ray-box tests"},
      {"primitive_tests", "ray-primitive tests"},
      {"sphere_tests", "tests of spheres, if the structure counts tests by kind of primitive"},
      {"cone_tests", "tests of cones and cylinders"},
      {"polygon_tests", "tests of polygons, or of their triangles where these are tested singly"},
  });
  return all;
}

void Registry::add(StructureInfo info) { structures_.push_back(std::move(info)); }

void Registry::describe_counters(const std::string& structure, std::vector<CounterInfo> counters) {
  own_counters_[structure] = std::move(counters);
}

std::span<const CounterInfo> Registry::own_counters(const std::string& structure) const {
  const auto found = own_counters_.find(structure);
  if (found == own_counters_.end()) return {};
  return found->second;
}

StructureChoice Registry::choose(const Spec& spec) const {
  const auto found =
      std::find_if(structures_.begin(), structures_.end(),
                   [&](const StructureInfo& info) { return info.name == spec.name; });
  if (found == structures_.end()) {
    std::vector<std::string> names;
    for (const auto& info : structures_) names.push_back(info.name);
    throw InputError(
        fmt::format("unknown structure '{}'; {}expected one of {}; those of a plug-in need "
                    "--plugin FILE",
                    excerpt(spec.name), did_you_mean(spec.name, names), fmt::join(names, ", ")));
  }
  for (const auto& [parameter, value] : spec.parameters) {
    require_own_parameter(*found, parameter);
  }
  return {*found, Parameters(found->name, found->parameters, spec.parameters)};
}

void Registry::require_own_parameter(const StructureInfo& structure,
                                     const std::string& name) const {
  const auto has = [&](const StructureInfo& info) {
    return std::ranges::find(info.parameters, name, &ParameterInfo::name) != info.parameters.end();
  };
  if (has(structure) || structure.parameters.empty()) return;
  std::vector<std::string> owners;
  for (const StructureInfo& info : structures_) {
    if (has(info)) owners.push_back(info.name);
  }
  if (owners.empty()) return;
  std::vector<std::string> valid;
  for (const ParameterInfo& info : structure.parameters) valid.push_back(info.name);
  throw InputError(
      fmt::format("{}: there is no parameter '{}', which belongs to {}; the valid ones are {}",
                  structure.name, excerpt(name), fmt::join(owners, ", "), fmt::join(valid, ", ")));
}

std::vector<StructureChoice> Registry::choose_all(const Spec& spec) const {
  if (spec != Spec{"all", {}}) return {choose(spec)};
  std::vector<StructureChoice> choices;
  for (const auto& info : structures_) choices.push_back(choose({info.name, {}}));
  return choices;
}

std::vector<StructureChoice> Registry::choose_list(std::string_view text) const {
  std::vector<StructureChoice> choices;
  for (const Spec& spec : parse_spec_list(text)) {
    std::ranges::move(choose_all(spec), std::back_inserter(choices));
  }
  return choices;
}

namespace {

Registry& whole_registry() {
  static Registry all = [] {
    Registry built;
    register_families(built);
    return built;
  }();
  return all;
}

}  // namespace

const Registry& registry() { return whole_registry(); }

void register_plugin_structures(std::vector<StructureInfo> structures) {
  for (StructureInfo& info : structures) whole_registry().add(std::move(info));
}

}  // namespace beambench::accel
