#pragma once
// The kinds of rays that structures are asked with.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/core/parameters.hpp"

namespace beambench::rays {

enum class RayKind {
  kPrimary,     ///< from the camera through the pixels
  kShadow,      ///< from where primary rays hit to the lights
  kReflection,  ///< mirrored where primary rays hit
  kDiffuse,     ///< scattered where primary rays hit
  kRandom,      ///< lines through the scene's box
  kWhitted      ///< all of a whole picture's, which follow from the structure's own hits
};

/// What is asked about a ray.
enum class Query {
  kClosestHit,
  kAnyHit,  ///< is there a hit at all?
  kPicture  ///< both, ray after ray as a whole picture needs them
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

}  // namespace beambench::rays
