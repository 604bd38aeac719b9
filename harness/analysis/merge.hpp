#pragma once
// Joins the shards of a sweep into one run.

#include <cstdio>
#include <filesystem>
#include <span>

#include "harness/analysis/analysis.hpp"

namespace beambench::analysis {

/// Writes a run of the whole sweep to the folder `output`, which must not exist yet: the cells of
/// all shards, each with the machine on which it was measured; a manifest with the conditions of
/// every shard; and the files made from them (`conclude`). Everything is written under a temporary
/// name and renamed at the end. The shards are unchanged. Progress goes to `messages`.
///
/// Throws InputError naming the folder or the cell: if a folder does not contain a finished shard;
/// if a shard is missing or appears twice; if two shards belong to different sweeps, divisions,
/// builds, plug-ins or scenes; if two contain the same cell (above all, with different counters);
/// or if `output` exists.
Analysis merge_shards(std::span<const std::filesystem::path> folders,
                      const std::filesystem::path& output, std::FILE* messages);

}  // namespace beambench::analysis
