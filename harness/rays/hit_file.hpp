#pragma once
// Hit files: binary (`.hits`) and CSV.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "harness/rays/claimed_hits.hpp"
#include "harness/rays/ray_kind.hpp"
#include "harness/rays/trace_results.hpp"

namespace beambench::rays {

/// The extension of binary hit files.
inline constexpr std::string_view kHitFileEnding = ".hits";

/// A `.hits` file has three parts: the line `beambench-hits 1`; one line of JSON; then the hits,
/// one for each ray in the order of the rays, without padding, in little-endian order. The JSON
/// must have `hits` (their number) and `columns`, the names of a hit's numbers in order; other
/// members are for human readers. The columns are one of
///
///     t                 float32   the hit is at origin + t * direction; infinity: a miss
///     x, y, z           float32   the point that is hit; all infinite: a miss
///
/// and, if available, one of
///
///     primitive         uint32    the id in the scene; 4294967295: a miss
///     triangle          uint32    the triangle, as `beambench export` numbers them; 4294967295:
///     a miss
///
/// or, for any-hit queries, only `occluded`, one byte: 1 if the ray hits something, otherwise 0. In
/// Python:
///
///     hits = numpy.zeros(len(rays), [("t", "<f4"), ("primitive", "<u4")])
///     with open(path, "wb") as f:
///         f.write(b"beambench-hits 1\n")
///         f.write(b'{"hits": %d, "columns": ["t", "primitive"]}\n' % len(hits))
///         hits.tofile(f)
///
/// A CSV file has the same columns, in any order. A miss has empty cells, or `inf` and -1.
///
/// Writes a CSV file if the extension is `.csv`, otherwise a binary one, with t and primitive, or
/// with occluded. Throws InputError if the file cannot be written, and then leaves no file.
void write_hit_file(const std::filesystem::path& path, const TraceResults& results,
                    const nlohmann::ordered_json& note);

/// Reads a hit file in parts. The first line determines the format. verify::ClaimVerifier checks
/// the values of the hits.
class HitReader {
 public:
  /// Throws InputError with the file name and the problem: it is not a hit file, has another
  /// version, has columns that are unknown or cannot be combined, or is too short or too long.
  explicit HitReader(const std::filesystem::path& path);
  ~HitReader();
  HitReader(HitReader&&) noexcept;
  HitReader& operator=(HitReader&&) = delete;

  /// Returns the query, which follows from the columns.
  Query query() const;
  /// Returns the number of hits stated in the file; nothing for CSV.
  std::optional<std::uint64_t> count() const;
  /// Replaces the table's content with the next hits, at most `at_most`, and returns their number,
  /// which is smaller only at the end of the file. Throws InputError naming the line of a CSV file
  /// if it does not contain numbers.
  std::size_t read(std::size_t at_most, HitTable& hits);
  /// Returns the place of a hit in the file, such as `hits.csv:18` or `some.hits: byte 1234`.
  std::string place_of(std::size_t index) const;

  struct Format;

 private:
  std::unique_ptr<Format> format_;
};

}  // namespace beambench::rays
