#pragma once
// The part of a sweep that a run is, as the user writes it and as its manifest has it.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace beambench::measure {

/// One part of a sweep that is divided among machines or processes.
struct Shard {
  int number;  ///< from 1 to `count`
  int count;   ///< of all parts

  friend bool operator==(const Shard&, const Shard&) = default;
};

/// The facts that the manifest of a shard records, from which `merge` finds out whether all shards
/// are complete.
struct ShardFacts {
  Shard shard;
  std::size_t cells;           ///< of the shard
  std::size_t cells_of_sweep;  ///< of all shards
};

/// Reads `2/4`. Throws InputError unless it is K/N with K from 1 to N.
Shard parse_shard(std::string_view text);

/// Returns `2/4`, as parse_shard reads it.
std::string to_string(const Shard& shard);

/// Returns the facts as a member of the manifest.
nlohmann::ordered_json to_json(const ShardFacts& facts);

/// Returns the facts in the manifest of a run; nothing if the run is not a shard.
std::optional<ShardFacts> shard_of_manifest(const nlohmann::ordered_json& manifest);

/// Returns whether a manifest is that of a run that was merged from shards.
bool is_merged(const nlohmann::ordered_json& manifest);

}  // namespace beambench::measure
