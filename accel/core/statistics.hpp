#pragma once
// Statistics that a structure reports after its build.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace beambench::accel {

/// The way in which a structure receives the rays of an image (`Accelerator::closest_hits`):
/// generating rays and storing hits is the harness's share of a trace.
enum class ImageRays : std::uint8_t {
  kSingle,  ///< one by one, from `PrimaryRays::ray`
  kSimd,    ///< in packets, generated (for lists, gathered) and stored by SIMD
  kOwn      ///< generates its own samples or needs no rays: the harness has no share
};

/// Sizes of a built structure; a quantity that a family lacks is 0.
struct Statistics {
  std::uint64_t nodes = 0;         ///< interior nodes and leaves
  std::uint64_t leaves = 0;        ///< empty ones included
  std::uint64_t empty_leaves = 0;  ///< leaves without a reference
  std::uint64_t references = 0;    ///< entries in the leaves' lists of primitives
  std::uint64_t depth = 0;         ///< level of the deepest leaf; the root has level 1
  std::uint64_t bytes = 0;         ///< memory the structure holds, without the scene
  /// The SIMD instruction set that its queries selected ("AVX2"). Empty if the queries are scalar
  /// code, compiled for what the build's flags allow.
  std::string instruction_set;
  ImageRays image_rays = ImageRays::kSingle;
  /// The library's geometry types that hold the primitives, joined by '+'; empty if the project's
  /// own functions test them (accel/core/intersect.hpp).
  std::string library_geometry;
  /// The library that traces the rays, with its version: "Embree 3.13.5"; empty for the project's
  /// own code.
  std::string library_version;
  std::vector<std::pair<std::string, double>> more;  ///< figures that the family adds, by name

  /// Returns a figure of `more`; nothing if the family does not add it.
  std::optional<double> figure(std::string_view name) const {
    const auto found = std::ranges::find(more, name, &std::pair<std::string, double>::first);
    return found == more.end() ? std::nullopt : std::optional(found->second);
  }
};

}  // namespace beambench::accel
