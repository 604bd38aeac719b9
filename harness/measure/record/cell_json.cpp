#include "harness/measure/record/cell_json.hpp"

#include <charconv>
#include <cmath>
#include <string>
#include <string_view>
#include <type_traits>

#include <fmt/format.h>

#include "harness/rays/fingerprint.hpp"
#include "scenes/base/error.hpp"

namespace beambench::measure {
namespace {

using Json = nlohmann::ordered_json;

/// Returns the enumerator, from 0 to `last`, for which `to_string` returns the name.
template <class Enum>
Enum named(const Json& value, Enum last) {
  const auto& name = value.get_ref<const std::string&>();
  for (int i = 0; i <= static_cast<int>(last); ++i) {
    if (to_string(static_cast<Enum>(i)) == name) return static_cast<Enum>(i);
  }
  throw InputError(fmt::format("'{}' is not a name that this version supports", name));
}

std::uint64_t hexadecimal(const Json& value) {
  const auto& digits = value.get_ref<const std::string&>();
  std::uint64_t number = 0;
  const char* const end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, number, 16);
  if (error != std::errc() || stop != end) {
    throw InputError(fmt::format("'{}' is not a hexadecimal number", digits));
  }
  return number;
}

template <class Value>
void add(Json& json, const char* name, const std::optional<Value>& value) {
  if (value) json[name] = *value;
}

template <class Value>
std::optional<Value> optional(const Json& json, const std::string& name) {
  const auto found = json.find(name);
  return found == json.end() ? std::nullopt : std::optional(found->template get<Value>());
}

// These functions call `visit` with the name and the value of each plain member; used both to read
// and to write.

template <class Facts, class Visit>
void for_each_member(std::type_identity<RaySetFacts>, Facts& facts, Visit visit) {
  visit("seed", facts.seed);
  visit("primitives", facts.primitives);
  visit("rays", facts.rays);
}

template <class Statistics, class Visit>
void for_each_member(std::type_identity<accel::Statistics>, Statistics& statistics, Visit visit) {
  visit("nodes", statistics.nodes);
  visit("leaves", statistics.leaves);
  visit("empty_leaves", statistics.empty_leaves);
  visit("references", statistics.references);
  visit("depth", statistics.depth);
  visit("bytes", statistics.bytes);
  visit("instruction_set", statistics.instruction_set);
  visit("library_geometry", statistics.library_geometry);
  visit("library_version", statistics.library_version);
}

template <class Timed, class Visit>
void for_each_member(std::type_identity<Repetition>, Timed& repetition, Visit visit) {
  visit("round", repetition.round);
  visit("position", repetition.position);
  visit("build_ms", repetition.build_ms);
  visit("trace_ms", repetition.trace_ms);
  visit("build_cpu_ms", repetition.build_cpu_ms);
  visit("trace_cpu_ms", repetition.trace_cpu_ms);
  visit("clock_ghz", repetition.clock_ghz);
}

template <class Record>
void write_members(const Record& record, Json& json) {
  for_each_member(std::type_identity<Record>(), record,
                  [&](const char* name, const auto& member) { json[name] = member; });
}

template <class Record>
void read_members(const Json& json, Record& record) {
  for_each_member(std::type_identity<Record>(), record,
                  [&](const char* name, auto& member) { json.at(name).get_to(member); });
}

Json rays_json(const RaySetFacts& facts) {
  Json json{{"scene_hash", rays::hex_digits(facts.scene_hash)},
            {"rays_hash", rays::hex_digits(facts.rays_hash)}};
  write_members(facts, json);
  json["query"] = rays::to_string(facts.query);
  add(json, "hit_share", facts.hit_share);
  add(json, "occluded_share", facts.occluded_share);
  add(json, "coherence", facts.coherence);
  return json;
}

RaySetFacts read_rays(const Json& json) {
  RaySetFacts facts;
  facts.scene_hash = hexadecimal(json.at("scene_hash"));
  facts.rays_hash = hexadecimal(json.at("rays_hash"));
  read_members(json, facts);
  facts.query = named(json.at("query"), rays::Query::kPicture);
  facts.hit_share = optional<double>(json, "hit_share");
  facts.occluded_share = optional<double>(json, "occluded_share");
  facts.coherence = optional<double>(json, "coherence");
  return facts;
}

Json statistics_json(const accel::Statistics& statistics) {
  Json json = Json::object();
  write_members(statistics, json);
  Json more = Json::object();
  for (const auto& [name, value] : statistics.more) more[name] = value;
  json["family"] = more;
  return json;
}

accel::Statistics read_statistics(const Json& json) {
  accel::Statistics statistics;
  read_members(json, statistics);
  for (const auto& [name, value] : json.at("family").items()) {
    statistics.more.emplace_back(name, value.is_null() ? std::nan("") : value.get<double>());
  }
  return statistics;
}

Json kinds_json(const std::vector<RaysOfKind>& kinds) {
  Json list = Json::array();
  for (const RaysOfKind& kind : kinds) {
    list.push_back({{"kind", kind.kind}, {"rays", kind.rays}, {"counters", kind.counters}});
  }
  return list;
}

void add_counts(Json& json, std::string_view phase, const HardwareCounts& counts) {
  for (std::size_t event = 0; event < counts.size(); ++event) {
    if (counts[event]) json[fmt::format("{}_{}", phase, kHardwareEvents[event])] = *counts[event];
  }
}

void read_counts(const Json& json, std::string_view phase, HardwareCounts& counts) {
  for (std::size_t event = 0; event < counts.size(); ++event) {
    counts[event] =
        optional<std::uint64_t>(json, fmt::format("{}_{}", phase, kHardwareEvents[event]));
  }
}

}  // namespace

Json facts_json(const CellRecord& cell) {
  Json json{{"name", cell.id.name()},
            {"key", cell.id.key()},
            {"scene", cell.id.scene},
            {"camera", cell.id.camera},
            {"structure", cell.id.structure},
            {"parameters", cell.id.parameters},
            {"width", cell.id.resolution.width},
            {"height", cell.id.resolution.height},
            {"samples", cell.id.samples},
            {"ray_kind", cell.id.rays},
            {"ray_set", rays_json(cell.rays)},
            {"counters", cell.work.counters}};
  if (cell.parameter_sets > 1) json["parameter_sets"] = cell.parameter_sets;
  if (!cell.work.kinds.empty()) json["ray_kinds"] = kinds_json(cell.work.kinds);
  if (cell.statistics) json["statistics"] = statistics_json(*cell.statistics);
  add(json, "allocated_bytes", cell.allocated_bytes);
  add(json, "peak_build_bytes", cell.peak_build_bytes);
  if (cell.harness) {
    json["harness"] = {{"path", to_string(cell.harness->path)}, {"ms", cell.harness->ms}};
  }
  if (!cell.columns.empty()) json["columns"] = cell.columns;
  return json;
}

void read_facts(const Json& event, CellRecord& cell) {
  event.at("scene").get_to(cell.id.scene);
  event.at("camera").get_to(cell.id.camera);
  event.at("structure").get_to(cell.id.structure);
  event.at("parameters").get_to(cell.id.parameters);
  event.at("width").get_to(cell.id.resolution.width);
  event.at("height").get_to(cell.id.resolution.height);
  event.at("samples").get_to(cell.id.samples);
  event.at("ray_kind").get_to(cell.id.rays);
  cell.rays = read_rays(event.at("ray_set"));
  cell.parameter_sets = event.value("parameter_sets", 1);
  event.at("counters").get_to(cell.work.counters);
  cell.work.kinds.clear();
  for (const Json& kind : event.value("ray_kinds", Json::array())) {
    cell.work.kinds.push_back({kind.at("kind").get<std::string>(),
                               kind.at("rays").get<std::uint64_t>(),
                               kind.at("counters").get<NamedCounters>()});
  }
  if (event.contains("statistics")) cell.statistics = read_statistics(event.at("statistics"));
  cell.allocated_bytes = optional<std::uint64_t>(event, "allocated_bytes");
  cell.peak_build_bytes = optional<std::uint64_t>(event, "peak_build_bytes");
  if (event.contains("harness")) {
    const Json& harness = event.at("harness");
    cell.harness = HarnessShare{named(harness.at("path"), QueryPath::kPicture),
                                harness.at("ms").get<double>()};
  }
  cell.columns = event.value("columns", decltype(cell.columns)());
  cell.shard = event.value("shard", 0);
}

Json repetition_json(const Repetition& repetition) {
  Json json = Json::object();
  if (repetition.block >= 0) json["block"] = repetition.block;
  write_members(repetition, json);
  add(json, "warm_trace_ms", repetition.warm_trace_ms);
  add(json, "update_ms", repetition.update_ms);
  add(json, "update_cpu_ms", repetition.update_cpu_ms);
  add_counts(json, "build", repetition.build_counts);
  add_counts(json, "trace", repetition.trace_counts);
  return json;
}

Repetition read_repetition(const Json& event) {
  Repetition repetition{};
  read_members(event, repetition);
  repetition.block = event.value("block", -1);
  repetition.warm_trace_ms = optional<double>(event, "warm_trace_ms");
  repetition.update_ms = optional<double>(event, "update_ms");
  repetition.update_cpu_ms = optional<double>(event, "update_cpu_ms");
  read_counts(event, "build", repetition.build_counts);
  read_counts(event, "trace", repetition.trace_counts);
  return repetition;
}

Json verification_json(const CellRecord& cell) {
  Json json{{"hits_hash", rays::hex_digits(cell.hits_hash.value())},
            {"rays", cell.diff.value().rays},
            {"hits", cell.diff->hits}};
  for (std::size_t i = 0; i < verify::kRecordedClassNames.size(); ++i) {
    json[std::string(verify::kRecordedClassNames[i])] = cell.diff->counts[i];
  }
  json["verdict"] = to_string(cell.diff->verdict);
  return json;
}

void read_verification(const Json& event, CellRecord& cell) {
  cell.hits_hash = hexadecimal(event.at("hits_hash"));
  verify::DiffReport& report = cell.diff.emplace();
  event.at("rays").get_to(report.rays);
  event.at("hits").get_to(report.hits);
  for (std::size_t i = 0; i < verify::kRecordedClassNames.size(); ++i) {
    event.at(std::string(verify::kRecordedClassNames[i])).get_to(report.counts[i]);
  }
  report.verdict = named(event.at("verdict"), verify::Verdict::kUnsupported);
  cell.verdict = report.verdict;
}

Json finish_json(const CellRecord& cell) {
  Json json{{"time_utc", cell.time_utc}, {"verdict", to_string(cell.verdict)}};
  if (cell.stop_reason) json["stop_reason"] = to_string(*cell.stop_reason);
  if (!cell.message.empty()) json["message"] = cell.message;
  if (!cell.examples.empty()) json["examples"] = cell.examples;
  return json;
}

void read_finish(const Json& event, CellRecord& cell) {
  event.at("time_utc").get_to(cell.time_utc);
  cell.verdict = named(event.at("verdict"), verify::Verdict::kUnsupported);
  if (event.contains("stop_reason")) {
    cell.stop_reason = named(event.at("stop_reason"), StopReason::kRepetitions);
  }
  cell.message = event.value("message", "");
  cell.examples = event.value("examples", std::vector<std::string>());
  cell.is_finished = true;
}

}  // namespace beambench::measure
