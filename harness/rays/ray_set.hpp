#pragma once
// A list of rays that is made once and traced by every structure; in memory and in files.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "accel/core/primary_rays.hpp"
#include "accel/core/ray.hpp"
#include "accel/core/ray_batch.hpp"
#include "harness/rays/ray_kind.hpp"

namespace beambench::rays {

/// A batch, and what it refers to.
struct RayList {
  std::vector<accel::Ray> rays{};
  std::vector<std::uint32_t> samples{};  ///< of each ray; none where they come from no image
  std::shared_ptr<const accel::PrimaryRays> image{};  ///< that they come from
  std::vector<accel::Pencil> pencils{};
  std::vector<std::shared_ptr<const accel::PrimaryRays>> views{};  ///< of pencils that have one

  accel::RayBatch batch() const { return {rays, pencils, samples, image.get()}; }
};

/// Rays, what is to be found for them, and where they come from.
struct RaySet : RayList {
  std::string label{};  ///< as records and commands name it (`RayChoice::label`)
  Query query = Query::kClosestHit;
  std::uint64_t seed = 0;                     ///< 0 where nothing is random
  std::optional<std::uint64_t> scene_hash{};  ///< of the scene they were made for, where known
};

/// The coherence of a list: the mean cosine of the angle between the directions of a ray
/// and the next. 1: all parallel; 0: nothing in common. 1 for fewer than two rays.
double coherence(std::span<const accel::Ray> rays);

/// A ray file has three parts: the line `beambench-rays 1`; one line of JSON; then the rays, each
/// as eight 32-bit IEEE floats in little-endian order: origin, t_min, direction, t_max. The JSON
/// must have `query` ("closest" or "any") and `rays` (how many). `seed`, `scene_hash` (a file of
/// another scene is refused), `hash` (of the rays' bytes, XXH3; a damaged file is refused) and
/// `pencils` may be missing; other members, such as those of `note`, are for people. `pencils` is a
/// list of `{"first": 0, "count": 16, "apex": [x, y, z], "toward": true}`, in the order of `first`:
/// see `accel::Pencil`. Samples of an image and views are not saved. In Python:
///
///     with open(path, "rb") as f:
///         f.readline(); header = json.loads(f.readline())
///         rays = numpy.fromfile(f, "<f4").reshape(-1, 8)
///
/// Throws InputError when the file cannot be written; then there is none.
void write_ray_file(const std::filesystem::path& path, const RaySet& set,
                    const nlohmann::ordered_json& note);

/// Throws InputError naming the file and what is wrong with it: not a ray file, another version,
/// too short or too long, damaged, a ray (by its index) that `require_valid` refuses, or a pencil
/// (by its index) that is not in order, not of these rays or not finite. The set's label is the
/// path.
RaySet read_ray_file(const std::filesystem::path& path);

}  // namespace beambench::rays
