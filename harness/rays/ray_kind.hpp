#pragma once
// The kinds of rays that structures trace, and how a user names them.

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
  kShadow,      ///< from where primary rays hit to the lights
  kReflection,  ///< mirrored where primary rays hit
  kMirror,      ///< mirrored where primary rays hit planar mirrors
  kDiffuse,     ///< scattered where primary rays hit
  kOcclusion,   ///< short ones, several from each place where primary rays hit: ambient occlusion
  kPath,        ///< scattered where primary rays hit, and again where these hit
  kRandom,      ///< lines through the scene's box
  kWhitted      ///< all of a whole picture's, which follow from the structure's own hits
};

/// What is to be found for a ray.
enum class Query {
  kClosestHit,
  kAnyHit,  ///< is there a hit at all?
  kPicture  ///< both, in batches, as a whole picture needs them
};
std::string_view to_string(Query query);  // "closest", "any", "picture"

/// A kind as the user sees it in `beambench list`.
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

/// The endings by which a file of rays is distinguished from the name of a kind.
inline constexpr std::string_view kRayFileEnding = ".rays";
inline constexpr std::string_view kCsvEnding = ".csv";

/// Whether a text names a file of rays, by its ending.
inline bool is_ray_file(std::string_view text) {
  return text.ends_with(kRayFileEnding) || text.ends_with(kCsvEnding);
}

/// Rays as a user names them: a kind with its parameters, or a file.
struct RayChoice {
  RayKind kind = RayKind::kPrimary;  ///< of a file: whatever was saved
  std::uint64_t seed = 0;            ///< of a random kind; 0 for the others
  std::filesystem::path file;        ///< empty: the rays are made
  /// As records and commands name it: `shadow`, `diffuse`, `diffuse:seed=7`, or the file's name
  /// (`name_of_path`).
  std::string label = "primary";

  friend bool operator==(const RayChoice&, const RayChoice&) = default;
};

/// `primary`, `diffuse:seed=7`, `some/file.rays`. Throws InputError listing the valid names or
/// parameters. A file is not opened yet.
RayChoice parse_ray_choice(std::string_view text);
/// The values of a choice's parameters, those of a file's kind being none.
Parameters parameters_of(const RayChoice& choice);
/// A comma-separated list, each choice once. Throws as parse_ray_choice.
std::vector<RayChoice> parse_ray_choices(std::string_view list);

}  // namespace beambench::rays
