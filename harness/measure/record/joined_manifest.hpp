#pragma once
// The manifest of a run that is merged from shards.

#include <span>

#include <nlohmann/json.hpp>

namespace beambench::measure {

/// Makes one manifest from the manifests of all shards (at least one). Common values stay. Where
/// values differ, `machine` and `measurement` list all of them, except that the largest load and
/// noise are kept, and the throttling by CPU quotas is summed. `shards` has the conditions of each
/// shard. The run id is that of a run of the whole sweep that began with the first shard. The
/// overhead is added later.
nlohmann::ordered_json joined_manifest(std::span<const nlohmann::ordered_json> shards);

}  // namespace beambench::measure
