#pragma once
// The manifest of a run that is merged from shards.

#include <span>

#include <nlohmann/json.hpp>

namespace beambench::measure {

/// Makes one manifest from the manifests of all shards, of which there is at least one. Common
/// values stay; of different values, `machine` and `measurement` list all, except for the load and
/// the noise, whose largest is kept, and the throttling by CPU quotas, which is added up; `shards`
/// has the conditions of each. The run id is that of a run of the whole sweep that began with the
/// first shard. The overhead is added later.
nlohmann::ordered_json joined_manifest(std::span<const nlohmann::ordered_json> shards);

}  // namespace beambench::measure
