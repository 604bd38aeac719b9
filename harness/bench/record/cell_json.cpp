#include "harness/bench/record/cell_json.hpp"

#include <charconv>
#include <cmath>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "harness/rays/fingerprint.hpp"
#include "scenes/core/error.hpp"

namespace beambench::bench {
namespace {

using Json = nlohmann::ordered_json;

/// The enumerator of a name that `to_string` gives, from 0 to `last`.
template <class Enum>
Enum named(const Json& value, Enum last) {
  const auto& name = value.get_ref<const std::string&>();
  for (int i = 0; i <= static_cast<int>(last); ++i) {
    if (to_string(static_cast<Enum>(i)) == name) return static_cast<Enum>(i);
  }
  throw InputError(fmt::format("'{}' is no name that this version knows", name));
}

std::uint64_t hexadecimal(const Json& value) {
  const auto& digits = value.get_ref<const std::string&>();
  std::uint64_t number = 0;
  const char* const end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, number, 16);
  if (error != std::errc() || stop != end) {
    throw InputError(fmt::format("'{}' is no hexadecimal number", digits));
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

Json rays_json(const RaySetFacts& facts) {
  Json json{{"scene_hash", rays::hex_digits(facts.scene_hash)},
            {"rays_hash", rays::hex_digits(facts.rays_hash)},
            {"seed", facts.seed},
            {"primitives", facts.primitives},
            {"rays", facts.rays},
            {"query", rays::to_string(facts.query)}};
  add(json, "hit_share", facts.hit_share);
  add(json, "occluded_share", facts.occluded_share);
  add(json, "coherence", facts.coherence);
  return json;
}

RaySetFacts read_rays(const Json& json) {
  RaySetFacts facts;
  facts.scene_hash = hexadecimal(json.at("scene_hash"));
  facts.rays_hash = hexadecimal(json.at("rays_hash"));
  json.at("seed").get_to(facts.seed);
  json.at("primitives").get_to(facts.primitives);
  json.at("rays").get_to(facts.rays);
  facts.query = named(json.at("query"), rays::Query::kPicture);
  facts.hit_share = optional<double>(json, "hit_share");
  facts.occluded_share = optional<double>(json, "occluded_share");
  facts.coherence = optional<double>(json, "coherence");
  return facts;
}

Json statistics_json(const accel::Statistics& statistics) {
  Json more = Json::object();
  for (const auto& [name, value] : statistics.more) more[name] = value;
  return {{"nodes", statistics.nodes},
          {"leaves", statistics.leaves},
          {"empty_leaves", statistics.empty_leaves},
          {"references", statistics.references},
          {"depth", statistics.depth},
          {"bytes", statistics.bytes},
          {"instruction_set", statistics.instruction_set},
          {"library_geometry", statistics.library_geometry},
          {"library_version", statistics.library_version},
          {"family", more}};
}

accel::Statistics read_statistics(const Json& json) {
  accel::Statistics statistics;
  json.at("nodes").get_to(statistics.nodes);
  json.at("leaves").get_to(statistics.leaves);
  json.at("empty_leaves").get_to(statistics.empty_leaves);
  json.at("references").get_to(statistics.references);
  json.at("depth").get_to(statistics.depth);
  json.at("bytes").get_to(statistics.bytes);
  json.at("instruction_set").get_to(statistics.instruction_set);
  json.at("library_geometry").get_to(statistics.library_geometry);
  json.at("library_version").get_to(statistics.library_version);
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
  if (!cell.work.kinds.empty()) json["ray_kinds"] = kinds_json(cell.work.kinds);
  if (cell.statistics) json["statistics"] = statistics_json(*cell.statistics);
  add(json, "allocated_bytes", cell.allocated_bytes);
  if (cell.harness) {
    json["harness"] = {{"path", to_string(cell.harness->path)}, {"ms", cell.harness->ms}};
  }
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
  event.at("counters").get_to(cell.work.counters);
  cell.work.kinds.clear();
  for (const Json& kind : event.value("ray_kinds", Json::array())) {
    cell.work.kinds.push_back({kind.at("kind").get<std::string>(),
                               kind.at("rays").get<std::uint64_t>(),
                               kind.at("counters").get<NamedCounters>()});
  }
  if (event.contains("statistics")) cell.statistics = read_statistics(event.at("statistics"));
  cell.allocated_bytes = optional<std::uint64_t>(event, "allocated_bytes");
  if (event.contains("harness")) {
    const Json& harness = event.at("harness");
    cell.harness = HarnessShare{named(harness.at("path"), QueryPath::kPicture),
                                harness.at("ms").get<double>()};
  }
  cell.shard = event.value("shard", 0);
}

Json repetition_json(const Repetition& repetition) {
  Json json{{"round", repetition.round},
            {"position", repetition.position},
            {"build_ms", repetition.build_ms},
            {"trace_ms", repetition.trace_ms},
            {"build_cpu_ms", repetition.build_cpu_ms},
            {"trace_cpu_ms", repetition.trace_cpu_ms},
            {"clock_ghz", repetition.clock_ghz}};
  add(json, "warm_trace_ms", repetition.warm_trace_ms);
  add_counts(json, "build", repetition.build_counts);
  add_counts(json, "trace", repetition.trace_counts);
  return json;
}

Repetition read_repetition(const Json& event) {
  Repetition repetition{};
  event.at("round").get_to(repetition.round);
  event.at("position").get_to(repetition.position);
  event.at("build_ms").get_to(repetition.build_ms);
  event.at("trace_ms").get_to(repetition.trace_ms);
  event.at("build_cpu_ms").get_to(repetition.build_cpu_ms);
  event.at("trace_cpu_ms").get_to(repetition.trace_cpu_ms);
  event.at("clock_ghz").get_to(repetition.clock_ghz);
  repetition.warm_trace_ms = optional<double>(event, "warm_trace_ms");
  read_counts(event, "build", repetition.build_counts);
  read_counts(event, "trace", repetition.trace_counts);
  return repetition;
}

Json verification_json(const CellRecord& cell) {
  Json json{{"hits_hash", rays::hex_digits(cell.hits_hash.value())},
            {"rays", cell.diff.value().rays},
            {"hits", cell.diff->hits}};
  for (std::size_t i = 0; i < verify::kDiffClassNames.size(); ++i) {
    json[std::string(verify::kDiffClassNames[i])] = cell.diff->counts[i];
  }
  json["verdict"] = to_string(cell.diff->verdict);
  return json;
}

void read_verification(const Json& event, CellRecord& cell) {
  cell.hits_hash = hexadecimal(event.at("hits_hash"));
  verify::DiffReport& report = cell.diff.emplace();
  event.at("rays").get_to(report.rays);
  event.at("hits").get_to(report.hits);
  for (std::size_t i = 0; i < verify::kDiffClassNames.size(); ++i) {
    event.at(std::string(verify::kDiffClassNames[i])).get_to(report.counts[i]);
  }
  report.verdict = named(event.at("verdict"), verify::Verdict::kNoRays);
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
  cell.verdict = named(event.at("verdict"), verify::Verdict::kNoRays);
  if (event.contains("stop_reason")) {
    cell.stop_reason = named(event.at("stop_reason"), StopReason::kRepetitions);
  }
  cell.message = event.value("message", "");
  cell.examples = event.value("examples", std::vector<std::string>());
  cell.is_finished = true;
}

}  // namespace beambench::bench
