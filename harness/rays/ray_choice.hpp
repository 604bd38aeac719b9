#pragma once
// Rays as a user asks for them: a kind with its parameters, or a file.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "harness/rays/ray_kind.hpp"

namespace beambench::rays {

/// The ending that tells a file of rays from the name of a kind.
inline constexpr std::string_view kRayFileEnding = ".rays";

struct RayChoice {
  RayKind kind = RayKind::kPrimary;  ///< of a file: whatever was saved
  std::uint64_t seed = 0;            ///< of a random kind; 0 for the others
  std::filesystem::path file;        ///< empty: the rays are made
  /// As records and commands name it: `shadow`, `diffuse`, `diffuse:seed=7`, or the file's path.
  std::string label = "primary";

  friend bool operator==(const RayChoice&, const RayChoice&) = default;
};

/// `primary`, `diffuse:seed=7`, `some/file.rays`. Throws InputError listing the valid names or
/// parameters. A file is not opened yet.
RayChoice parse_ray_choice(std::string_view text);
/// A comma-separated list, each choice once. Throws as parse_ray_choice.
std::vector<RayChoice> parse_ray_choices(std::string_view list);

}  // namespace beambench::rays
