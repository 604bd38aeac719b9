#pragma once
// Statistics that a structure reports after it was built.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace beambench::accel {

/// The way in which a structure receives the rays of an image (`Accelerator::closest_hits`): making
/// them and storing the hits is the harness's own share of a trace.
enum class ImageRays : std::uint8_t {
  kSingle,  ///< one by one, from `PrimaryRays::ray`
  kSimd,    ///< in packets made (of a list: filled) by SIMD, hits stored by SIMD
  kOwn      ///< makes samples of its own, or needs no rays: the harness has no share
};

/// Sizes of a built structure; 0 where a family has no such thing.
struct Statistics {
  std::uint64_t nodes = 0;         ///< interior nodes and leaves
  std::uint64_t leaves = 0;        ///< empty ones included
  std::uint64_t empty_leaves = 0;  ///< leaves without a reference
  std::uint64_t references = 0;    ///< entries in the leaves' lists of primitives
  std::uint64_t depth = 0;         ///< levels of the deepest leaf, the root being level 1
  std::uint64_t bytes = 0;         ///< memory the structure holds, without the scene
  /// Whether its queries use SIMD, and which: the instruction set that they selected ("AVX2").
  /// Empty: none, they are scalar code, compiled for what the build's flags allow.
  std::string instruction_set;
  ImageRays image_rays = ImageRays::kSingle;
  /// The types in which a library holds the primitives, joined by '+'; empty where they are tested
  /// by the project's own functions (accel/core/intersect.hpp).
  std::string library_geometry;
  /// The library whose code traces, and its version: "Embree 3.13.5"; empty: the project's own
  /// code.
  std::string library_version;
  std::vector<std::pair<std::string, double>> more;  ///< what the family adds, by name

  /// Returns a figure of `more`; nothing where the family does not add it.
  std::optional<double> figure(std::string_view name) const {
    const auto found = std::ranges::find(more, name, &std::pair<std::string, double>::first);
    return found == more.end() ? std::nullopt : std::optional(found->second);
  }
};

}  // namespace beambench::accel
