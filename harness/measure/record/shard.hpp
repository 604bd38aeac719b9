#pragma once
// The part of a sweep that a run measures, as specified by the user and as recorded in its
// manifest.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace beambench::measure {

/// One part of a sweep that is divided among machines or processes.
struct Shard {
  int number;  ///< from 1 to `count`
  int count;   ///< the number of shards

  friend bool operator==(const Shard&, const Shard&) = default;
};

/// The facts recorded in a shard's manifest, by which `merge` checks that all shards are complete.
struct ShardFacts {
  Shard shard;
  std::size_t cells;           ///< cells of the shard
  std::size_t cells_of_sweep;  ///< cells of all shards
};

/// Parses `2/4`. Throws InputError unless the string is K/N with K from 1 to N.
Shard parse_shard(std::string_view text);

/// Returns `2/4`, the form read by parse_shard.
std::string to_string(const Shard& shard);

/// Returns the facts as a member of the manifest.
nlohmann::ordered_json to_json(const ShardFacts& facts);

/// Returns the facts stated in the manifest of a run; nothing if the run is not a shard.
std::optional<ShardFacts> shard_of_manifest(const nlohmann::ordered_json& manifest);

/// Returns whether a manifest belongs to a run that was merged from shards.
bool is_merged(const nlohmann::ordered_json& manifest);

}  // namespace beambench::measure
