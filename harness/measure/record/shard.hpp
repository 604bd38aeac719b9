#pragma once
// Which part of a sweep a run is, as the user writes it and as its manifest has it.

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

/// What the manifest of a shard records, by which `merge` finds out whether all is there.
struct ShardFacts {
  Shard shard;
  std::size_t cells;           ///< of the shard
  std::size_t cells_of_sweep;  ///< of all shards
};

/// Reads `2/4`. Throws InputError unless it is K/N with K from 1 to N.
Shard parse_shard(std::string_view text);

/// `2/4`, as parse_shard reads it.
std::string to_string(const Shard& shard);

/// As a member of the manifest.
nlohmann::ordered_json to_json(const ShardFacts& facts);

/// What the manifest of a run states; nothing of a run that is no shard.
std::optional<ShardFacts> shard_of_manifest(const nlohmann::ordered_json& manifest);

/// Whether a manifest is that of a run that was merged from shards.
bool is_merged(const nlohmann::ordered_json& manifest);

}  // namespace beambench::measure
