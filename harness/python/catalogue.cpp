// Lists structures, scenes and kinds of rays with their parameters.

#include "scenes/catalogue.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include "accel/core/registry.hpp"
#include "harness/python/bindings.hpp"
#include "harness/rays/ray_kind.hpp"
#include "scenes/base/parameters.hpp"

namespace beambench::python {
namespace {

namespace nb = nanobind;

const char* name_of(ParameterInfo::Type type) {
  switch (type) {
    case ParameterInfo::Type::kInteger:
      return "integer";
    case ParameterInfo::Type::kIntegerOrAuto:
      return "integer or auto";
    case ParameterInfo::Type::kReal:
      return "real";
    case ParameterInfo::Type::kFlag:
      return "flag";
    case ParameterInfo::Type::kChoice:
      return "choice";
    case ParameterInfo::Type::kCells:
      return "cells";
  }
  return "";
}

const char* name_of(accel::Conformance conformance) {
  switch (conformance) {
    case accel::Conformance::kBitExact:
      return "bit-exact";
    case accel::Conformance::kTolerance:
      return "tolerance";
    case accel::Conformance::kBaseline:
      return "baseline";
  }
  return "";
}

Records parameters_of(std::span<const ParameterInfo> infos) {
  Records parameters;
  for (const ParameterInfo& info : infos) {
    const bool has_range =
        info.type != ParameterInfo::Type::kFlag && info.type != ParameterInfo::Type::kChoice;
    Record entry;
    entry["name"] = info.name;
    entry["type"] = name_of(info.type);
    entry["default"] = info.default_value;
    entry["minimum"] = has_range ? nb::object(nb::float_(info.minimum)) : nb::none();
    entry["maximum"] = has_range ? nb::object(nb::float_(info.maximum)) : nb::none();
    nb::list choices;
    for (const std::string& choice : info.choices) choices.append(choice);
    entry["choices"] = nb::tuple(choices);
    entry["description"] = info.description;
    parameters.append(entry);
  }
  return parameters;
}

template <class Info>
Record entry_of(const Info& info) {
  Record entry;
  entry["name"] = info.name;
  entry["summary"] = info.summary;
  entry["parameters"] = parameters_of(info.parameters);
  return entry;
}

Record counters_of(const std::string& structure) {
  Record counters;
  for (const accel::CounterInfo& info : accel::common_counters()) {
    counters[info.name.c_str()] = info.meaning;
  }
  for (const accel::CounterInfo& info : accel::registry().own_counters(structure)) {
    counters[info.name.c_str()] = info.meaning;
  }
  return counters;
}

Records structures() {
  Records all;
  for (const accel::StructureInfo& info : accel::registry().structures()) {
    Record entry = entry_of(info);
    entry["conformance"] = name_of(info.conformance);
    entry["counters"] = counters_of(info.name);
    all.append(entry);
  }
  return all;
}

Records scene_entries() {
  Records all;
  for (const scenes::SceneInfo& info : scenes::scene_catalogue()) all.append(entry_of(info));
  return all;
}

Records ray_kind_entries() {
  Records all;
  for (const rays::RayKindInfo& info : rays::ray_kinds()) {
    Record entry = entry_of(info);
    const std::string_view query = rays::to_string(info.query);
    entry["query"] = nb::str(query.data(), query.size());
    all.append(entry);
  }
  return all;
}

}  // namespace

void bind_catalogue(nb::module_& module) {
  module.def("structures", &structures, "All structures, each a dict.");
  module.def("scenes", &scene_entries, "All scenes of the catalogue, each a dict.");
  module.def("ray_kinds", &ray_kind_entries, "All kinds of rays, each a dict.");
}

}  // namespace beambench::python
