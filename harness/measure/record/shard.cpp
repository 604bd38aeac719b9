#include "harness/measure/record/shard.hpp"

#include <charconv>
#include <system_error>

#include <fmt/format.h>

#include "scenes/base/error.hpp"

namespace beambench::measure {
namespace {

/// Parses a string of digits; returns nothing for any other string.
std::optional<int> number_of(std::string_view text) {
  int number = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || stop != end || text.front() == '-') return std::nullopt;
  return number;
}

}  // namespace

Shard parse_shard(std::string_view text) {
  const std::size_t slash = text.find('/');
  if (slash != std::string_view::npos) {
    const auto number = number_of(text.substr(0, slash));
    const auto count = number_of(text.substr(slash + 1));
    if (number && count && *number >= 1 && *number <= *count) return {*number, *count};
  }
  throw InputError(
      fmt::format("--shard: expected K/N with K from 1 to N, such as 2/4, not '{}'", text));
}

std::string to_string(const Shard& shard) {
  return fmt::format("{}/{}", shard.number, shard.count);
}

nlohmann::ordered_json to_json(const ShardFacts& facts) {
  return {{"number", facts.shard.number},
          {"count", facts.shard.count},
          {"cells", facts.cells},
          {"cells_of_sweep", facts.cells_of_sweep}};
}

std::optional<ShardFacts> shard_of_manifest(const nlohmann::ordered_json& manifest) {
  const auto found = manifest.find("shard");
  if (found == manifest.end()) return std::nullopt;
  return ShardFacts{{found->at("number").get<int>(), found->at("count").get<int>()},
                    found->at("cells").get<std::size_t>(),
                    found->at("cells_of_sweep").get<std::size_t>()};
}

bool is_merged(const nlohmann::ordered_json& manifest) { return manifest.contains("shards"); }

}  // namespace beambench::measure
