#pragma once
// Files of hits: `.hits`, and CSV.

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

/// The ending of binary files of hits.
inline constexpr std::string_view kHitFileEnding = ".hits";

/// A `.hits` file has three parts: the line `beambench-hits 1`; one line of JSON; then the hits,
/// one for each ray in the order of the rays, without padding, in little-endian order. The JSON
/// must have `hits` (how many) and `columns`, the names of a hit's numbers in their order; other
/// members are for people. The columns are one of
///
///     t                 float32   origin + t * direction is hit; infinity: nothing is
///     x, y, z           float32   the point that is hit; all infinite: none is
///
/// and, where the program knows it, one of
///
///     primitive         uint32    the id in the scene; 4294967295: nothing is hit
///     triangle          uint32    the triangle, as `beambench export` numbers them; 4294967295:
///     none
///
/// or, for any hits, `occluded` alone, of one byte: 1 where the ray hits something, otherwise 0. In
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
/// The ending, `.csv` or another, decides what is written: t and primitive, or occluded. Throws
/// InputError when the file cannot be written; then there is none.
void write_hit_file(const std::filesystem::path& path, const TraceResults& results,
                    const nlohmann::ordered_json& note);

/// Reads a file of hits part by part. The first line tells the format. What the hits may hold is
/// left to verify::ClaimVerifier.
class HitReader {
 public:
  /// Throws InputError naming the file and what is wrong with it: not a file of hits, another
  /// version, columns that are unknown or do not go together, too short or too long.
  explicit HitReader(const std::filesystem::path& path);
  ~HitReader();
  HitReader(HitReader&&) noexcept;
  HitReader& operator=(HitReader&&) = delete;

  /// What was asked, as the columns tell.
  Query query() const;
  /// As the file states; nothing for CSV.
  std::optional<std::uint64_t> count() const;
  /// Replaces the table by the next hits, at most so many, and returns how many: fewer only at the
  /// end. Throws InputError with the line of a CSV file that holds no numbers.
  std::size_t read(std::size_t at_most, HitTable& hits);
  /// `hits.csv:18`, `some.hits: byte 1234`: the place of a hit.
  std::string place_of(std::size_t index) const;

  struct Format;

 private:
  std::unique_ptr<Format> format_;
};

}  // namespace beambench::rays
