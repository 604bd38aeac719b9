#pragma once
// The kinds of rays that structures are asked with.

#include <span>
#include <string_view>
#include <vector>

namespace beambench {

enum class RayKind {
  kPrimary  ///< from the camera through the pixels
};

/// A kind as the user sees it in `beambench list`.
struct RayKindInfo {
  RayKind kind;
  std::string_view name;
  std::string_view summary;
};

/// All kinds.
std::span<const RayKindInfo> ray_kinds();

std::string_view to_string(RayKind kind);

/// A kind by its name. Throws InputError listing the valid names.
RayKind parse_ray_kind(std::string_view name);
/// A comma-separated list of names, each once. Throws as parse_ray_kind.
std::vector<RayKind> parse_ray_kinds(std::string_view list);

}  // namespace beambench
