#pragma once
// Ray sets in files.

#include <filesystem>

#include <nlohmann/json.hpp>

#include "harness/rays/ray_set.hpp"

namespace beambench::rays {

/// A ray file has three parts: the line `beambench-rays 1`; one line of JSON; then the rays, each
/// as eight 32-bit IEEE floats in little-endian order: origin, t_min, direction, t_max. The JSON
/// must tell `query` ("closest" or "any") and `rays` (how many). `seed`, `scene_hash` (a file of
/// another scene is refused) and `hash` (of the rays' bytes, XXH3; a damaged file is refused) may
/// be missing; other members, such as those of `note`, are for people. In Python:
///
///     with open(path, "rb") as f:
///         f.readline(); header = json.loads(f.readline())
///         rays = numpy.fromfile(f, "<f4").reshape(-1, 8)
///
/// Throws InputError when the file cannot be written; then there is none.
void write_ray_file(const std::filesystem::path& path, const RaySet& set,
                    const nlohmann::ordered_json& note);

/// Throws InputError naming the file and what is wrong with it: not a ray file, another version,
/// too short or too long, damaged, or a ray (by its index) that `require_valid` refuses. The set's
/// label is the path.
RaySet read_ray_file(const std::filesystem::path& path);

}  // namespace beambench::rays
