#pragma once
// Joins the shards of a sweep into one run.

#include <cstdio>
#include <filesystem>
#include <span>

#include "harness/analysis/analysis.hpp"

namespace beambench::analysis {

/// Writes a run of the whole sweep to the folder `output`, which must not exist yet: the cells of
/// all shards, each with the machine that it was measured on; a manifest with the conditions of
/// every shard; and what is made from them (`conclude`). All of it is made beside its place and
/// renamed at the end. The shards stay as they are. Progress goes to `messages`.
///
/// Throws InputError naming the folder or the cell: where a folder holds no finished shard; where a
/// shard is missing or there twice; where two are of different sweeps, divisions, builds, plug-ins
/// or scenes; where a cell is in two of them, and with other counters above all; where `output`
/// exists.
Analysis merge_shards(std::span<const std::filesystem::path> folders,
                      const std::filesystem::path& output, std::FILE* messages);

}  // namespace beambench::analysis
