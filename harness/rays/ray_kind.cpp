#include "harness/rays/ray_kind.hpp"

#include <array>
#include <cstdint>

namespace beambench::rays {
namespace {

ParameterInfo seed_parameter() {
  return integer_parameter("seed", 1, 0, std::int64_t{1} << 53, "of the random numbers");
}

std::vector<ParameterInfo> whitted_parameters() {
  return {integer_parameter("depth", 5, 1, 64, "rays behind one another, the eye's included"),
          real_parameter("least_weight", 0.0, 0.0, 1.0,
                         "rays that are a smaller part of their pixel are not traced"),
          choice_parameter("shadows", "rays", {"rays", "cache", "light-buffer"},
                           "how it is found out whether a light is seen")};
}

const std::vector<RayKindInfo>& all_kinds() {
  static const std::vector<RayKindInfo> kinds{
      {RayKind::kPrimary,
       "primary",
       "from the camera through every sample of every pixel",
       Query::kClosestHit,
       {}},
      {RayKind::kShadow,
       "shadow",
       "from where primary rays hit to each light that the surface faces; any hit",
       Query::kAnyHit,
       {}},
      {RayKind::kReflection,
       "reflection",
       "mirrored at the surface where primary rays hit, as if all were mirrors",
       Query::kClosestHit,
       {}},
      {RayKind::kDiffuse,
       "diffuse",
       "one from each primary hit, its direction random by the cosine with the surface's normal",
       Query::kClosestHit,
       {seed_parameter()}},
      {RayKind::kRandom,
       "random",
       "as many as the image has samples, uniform among all lines through the scene's box",
       Query::kClosestHit,
       {seed_parameter()}},
      {RayKind::kWhitted, "whitted",
       "a whole picture: eye, shadow, reflected and refracted rays, which follow from the "
       "structure's own hits; 'run' and 'verify' judge every one",
       Query::kPicture, whitted_parameters()}};
  return kinds;
}

}  // namespace

std::string_view to_string(Query query) {
  constexpr std::array<std::string_view, 3> kNames{"closest", "any", "picture"};
  return kNames[static_cast<std::size_t>(query)];
}

std::span<const RayKindInfo> ray_kinds() { return all_kinds(); }

const RayKindInfo& info_of(RayKind kind) { return all_kinds()[static_cast<std::size_t>(kind)]; }

std::string_view to_string(RayKind kind) { return info_of(kind).name; }

}  // namespace beambench::rays
