#pragma once
// Ray files: binary (`.rays`) and CSV.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include <nlohmann/json_fwd.hpp>

#include "harness/rays/ray_set.hpp"

namespace beambench::rays {

/// A `.rays` file has three parts: the line `beambench-rays 1`; one line of JSON; then the rays,
/// each as eight 32-bit IEEE floats in little-endian order: origin, t_min, direction, t_max. The
/// JSON must have `query` ("closest" or "any") and `rays` (their number). `seed`, `scene_hash` (a
/// file for another scene is refused), `hash` (of the rays' bytes, XXH3; a damaged file is
/// refused), `may_graze`, `must_hit` (true or false: as in `RaySet`) and `pencils` are optional;
/// other members, such as `note`, are for human readers. `pencils` is a list of `{"first": 0,
/// "count": 16, "apex": [x, y, z], "toward": true}`, in the order of `first`: see `accel::Pencil`.
/// The image's samples, and the views and bundles of pencils, are not saved. In Python:
///
///     with open(path, "rb") as f:
///         f.readline(); header = json.loads(f.readline())
///         rays = numpy.fromfile(f, "<f4").reshape(-1, 8)
///
/// A CSV file has the columns ox, oy, oz, t_min, dx, dy, dz, t_max, in any order; t_min (0) and
/// t_max (infinity) may be missing or empty. Case is ignored, and names and numbers may be in
/// quotation marks. The query is "closest". The numbers are exact whether read as float or double.
///
/// Writes a CSV file if the extension is `.csv`, otherwise a binary one. Throws InputError if the
/// file cannot be written, and then leaves no file.
void write_ray_file(const std::filesystem::path& path, const RaySet& set,
                    const nlohmann::ordered_json& note);

/// Reads a ray file in parts. The first line determines the format.
class RayReader {
 public:
  /// Throws InputError with the file name and the problem: it is not a ray file, has another
  /// version, is too short or too long, or a pencil (named by its index) is out of order, beyond
  /// the rays or not finite.
  explicit RayReader(const std::filesystem::path& path);
  ~RayReader();
  RayReader(RayReader&&) noexcept;
  RayReader& operator=(RayReader&&) = delete;

  /// Returns the set without its rays; the label is the path.
  const RaySet& header() const;
  /// Returns the number of rays stated in the file; nothing for CSV.
  std::optional<std::uint64_t> count() const;
  /// Fills the buffer with the next rays and returns the number read, which is smaller only at the
  /// end of the file. Throws InputError naming the place of an invalid ray (`require_valid`), and
  /// at the end of a damaged file.
  std::size_t read(std::span<accel::Ray> rays);
  /// Returns the fraction read so far, from 0 to 1; 0 if unknown.
  double part() const;

  struct Format;

 private:
  std::unique_ptr<Format> format_;
};

/// Reads the whole file. Throws what RayReader throws, and InputError for more than 2^28 rays.
RaySet read_ray_file(const std::filesystem::path& path);

}  // namespace beambench::rays
