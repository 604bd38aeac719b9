#pragma once
// The kinds of rays that structures trace, and their names on the command line.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/base/parameters.hpp"

namespace beambench::rays {

enum class RayKind {
  kPrimary,     ///< from the camera through the pixels
  kShadow,      ///< from the hits of primary rays to the lights
  kArea,        ///< from the same hits to several points of each light, which has an extent
  kReflection,  ///< mirrored at the hits of primary rays
  kMirror,      ///< mirrored at the hits of primary rays with planar mirrors
  kDiffuse,     ///< scattered at the hits of primary rays
  kOcclusion,   ///< several short rays from each hit of a primary ray: ambient occlusion
  kPath,        ///< scattered at the hits of primary rays, and again at their own hits
  kRandom,      ///< lines through the scene's box
  kWhitted      ///< all rays of a whole picture, which follow from the structure's own hits
};

/// The default maximum number of rays of a whole picture that a structure receives at once. More
/// rays help streams (accel/bvh/README.md) and need more memory.
inline constexpr int kPictureBatch = 32768;
inline constexpr int kMaxPictureBatch = 1 << 19;

/// The result computed for a ray.
enum class Query {
  kClosestHit,
  kAnyHit,  ///< whether there is any hit
  kPicture  ///< closest-hit and any-hit queries, in batches, for a whole picture
};
std::string_view to_string(Query query);  // "closest", "any", "picture"

/// A kind as listed by `beambench list`.
struct RayKindInfo {
  RayKind kind;
  std::string name;
  std::string summary;
  Query query;
  std::vector<ParameterInfo> parameters;
};

/// All kinds, in the order of the enumeration.
std::span<const RayKindInfo> ray_kinds();

const RayKindInfo& info_of(RayKind kind);
std::string_view to_string(RayKind kind);

/// The extensions that distinguish a ray file from the name of a kind.
inline constexpr std::string_view kRayFileEnding = ".rays";
inline constexpr std::string_view kCsvEnding = ".csv";

/// Returns whether a string names a ray file, judging by its extension.
inline bool is_ray_file(std::string_view text) {
  return text.ends_with(kRayFileEnding) || text.ends_with(kCsvEnding);
}

/// The user's choice of rays: a kind with its parameters, or a file.
struct RayChoice {
  RayKind kind = RayKind::kPrimary;  ///< for a file: whatever was saved
  std::uint64_t seed = 0;            ///< for a random kind; 0 for other kinds
  bool is_sorted = false;            ///< a list that is not in the order of generation
  std::filesystem::path file{};      ///< empty: the rays are generated
  /// The name in records and commands: `shadow`, `diffuse`, `diffuse:seed=7`, or the file's name
  /// (`name_of_path`).
  std::string label = "primary";

  friend bool operator==(const RayChoice&, const RayChoice&) = default;
};

/// Parses `primary`, `diffuse:seed=7` or `some/file.rays`. Throws InputError listing the valid
/// names or parameters. A file is not opened yet.
RayChoice parse_ray_choice(std::string_view text);
/// The orders of the rays of a list, as named in records.
inline constexpr std::string_view kListOrder = "list";      ///< as generated or saved
inline constexpr std::string_view kSortedOrder = "sorted";  ///< by direction and origin
/// A label without the order, and the order.
struct OrderedLabel {
  std::string rays;
  std::string_view order;
};
/// Divides a label: `diffuse:order=sorted,seed=7` becomes `diffuse:seed=7` and `sorted`. Rays of a
/// file are in the file's order.
OrderedLabel divide_label(const std::string& label);

/// Returns the values of a choice's parameters; there are none for a file.
Parameters parameters_of(const RayChoice& choice);
/// Parses a comma-separated list; repeated choices are kept once. Throws what parse_ray_choice
/// throws.
std::vector<RayChoice> parse_ray_choices(std::string_view list);

}  // namespace beambench::rays
