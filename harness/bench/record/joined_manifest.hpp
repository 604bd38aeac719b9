#pragma once
// The manifest of a run that is merged from shards.

#include <optional>
#include <span>

#include <nlohmann/json.hpp>

namespace beambench::bench {

/// One manifest for the manifests of all shards, of which there is at least one. What they have in
/// common stays; of what differs, `machine` and `measurement` list the different values, but for
/// the load and the noise, whose largest is kept; `shards` has the conditions of each. The run id
/// is that of a run of the whole sweep that began with the first shard. There is no overhead yet.
nlohmann::ordered_json joined_manifest(std::span<const nlohmann::ordered_json> shards);

/// The largest noise of equal work before the shards were measured; nothing where no shard measured
/// it. Takes a `joined_manifest`.
std::optional<double> noise_of(const nlohmann::ordered_json& manifest);

/// The largest load average before the shards were measured. Takes a `joined_manifest`.
double load_of(const nlohmann::ordered_json& manifest);

}  // namespace beambench::bench
