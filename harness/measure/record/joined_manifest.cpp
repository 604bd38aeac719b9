#include "harness/measure/record/joined_manifest.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/measure/record/conditions.hpp"

namespace beambench::measure {
namespace {

using Json = nlohmann::ordered_json;

/// Returns the values of one member of an object in all manifests; null if it is missing.
std::vector<Json> values_of(std::span<const Json> shards, const char* object,
                            const std::string& name) {
  std::vector<Json> values;
  for (const Json& shard : shards) values.push_back(shard.at(object).value(name, Json()));
  return values;
}

/// Returns the distinct values, in order.
std::vector<Json> distinct(const std::vector<Json>& values) {
  std::vector<Json> found;
  for (const Json& value : values) {
    if (std::ranges::find(found, value) == found.end()) found.push_back(value);
  }
  return found;
}

/// Returns whether the largest of a member's values is kept, since larger values are worse.
bool is_disturbance(std::string_view name) {
  return name == "other_work" || name == "load_average" || name == "highest_load" ||
         name == "noise";
}

Json largest(const std::vector<Json>& values) {
  Json most;
  for (const Json& value : values) {
    if (value.is_number() && (most.is_null() || value > most)) most = value;
  }
  return most;
}

Json joined_value(const std::string& name, const std::vector<Json>& values) {
  if (is_disturbance(name)) return largest(values);
  const std::vector<Json> found = distinct(values);
  if (found.size() == 1) return found.front();
  // Readers expect the processor and the machine's id to be strings.
  if (std::ranges::all_of(found, [](const Json& value) { return value.is_string(); })) {
    std::vector<std::string> texts;
    for (const Json& value : found) texts.push_back(value.get<std::string>());
    return fmt::format("{}", fmt::join(texts, " and "));
  }
  return found;
}

/// Joins an object whose members all shards have, such as `machine`.
Json joined_object(std::span<const Json> shards, const char* object) {
  Json joined = Json::object();
  for (const auto& [name, value] : shards.front().at(object).items()) {
    joined[name] = joined_value(name, values_of(shards, object, name));
  }
  return joined;
}

/// Returns `20240531-140709.417-default-shard-2-of-4` without the shard's suffix.
std::string merged_run_id(std::span<const Json> shards) {
  std::string first;
  for (const Json& shard : shards) {
    std::string id = shard.at("run_id").get<std::string>();
    id = id.substr(0, id.rfind("-shard-"));
    if (first.empty() || id < first) first = id;
  }
  return first;
}

/// Returns the first or last value of a time in all manifests.
template <class Choose>
std::string time_of(std::span<const Json> shards, const char* member, Choose choose) {
  std::vector<std::string> times;
  for (const Json& shard : shards) times.push_back(shard.at(member).get<std::string>());
  return *choose(times);
}

/// Returns the conditions that could not be controlled in any of the shards; each sentence once.
std::vector<std::string> uncontrolled(std::span<const Json> shards) {
  std::vector<std::string> sentences;
  for (const Json& shard : shards) {
    for (const Json& each : shard.at("uncontrolled")) {
      const auto sentence = each.get<std::string>();
      if (std::ranges::find(sentences, sentence) == sentences.end()) sentences.push_back(sentence);
    }
  }
  return sentences;
}

std::optional<Throttling> throttling(std::span<const Json> shards) {
  std::optional<Throttling> total;
  for (const Json& shard : shards) total = added_up(total, conditions_of(shard).throttling);
  return total;
}

Json conditions(const Json& shard) {
  Json own{{"number", shard.at("shard").at("number")},
           {"cells", shard.at("shard").at("cells")},
           {"run_id", shard.at("run_id")}};
  for (const char* member : {"time_utc", "finished_utc", "machine", "measurement", "uncontrolled",
                             "part_begun_utc", "earlier_parts"}) {
    own[member] = shard.value(member, Json());
  }
  return own;
}

}  // namespace

Json joined_manifest(std::span<const Json> shards) {
  Json joined = shards.front();
  joined.erase("shard");
  joined["run_id"] = merged_run_id(shards);
  joined["time_utc"] =
      time_of(shards, "time_utc", [](auto& times) { return std::ranges::min_element(times); });
  joined["finished_utc"] =
      time_of(shards, "finished_utc", [](auto& times) { return std::ranges::max_element(times); });
  joined["machine"] = joined_object(shards, "machine");
  joined["measurement"] = joined_object(shards, "measurement");
  joined["measurement"]["throttling"] = to_json(throttling(shards));
  joined["uncontrolled"] = uncontrolled(shards);
  joined["part_begun_utc"] = joined["time_utc"];
  joined["earlier_parts"] = Json::array();
  Json& all = joined["shards"] = Json::array();
  for (const Json& shard : shards) all.push_back(conditions(shard));
  return joined;
}

}  // namespace beambench::measure
