#pragma once
// A picture with all that a structure was asked for it.

#include <array>
#include <cstddef>
#include <string_view>

#include "accel/hit_buffer.hpp"
#include "accel/primary_rays.hpp"
#include "harness/picture/image.hpp"
#include "harness/shade/watched_queries.hpp"
#include "harness/shade/whitted.hpp"

namespace beambench {

/// The kinds of rays that follow the eye's.
enum class FollowingRays : std::size_t { kReflected, kRefracted, kShadow, kCount };
inline constexpr auto kFollowingRays = static_cast<std::size_t>(FollowingRays::kCount);
template <class Value>
using ByFollowingRays = std::array<Value, kFollowingRays>;
inline constexpr ByFollowingRays<std::string_view> kFollowingRayNames{"reflected", "refracted",
                                                                      "shadow"};

struct RecordedPicture {
  HitBuffer eye;  ///< what the eye's rays found
  ByFollowingRays<AskedRays> asked;
  Image image;
  RayCensus census;
};

/// Draws the picture that `eye` begins, on this thread alone; some 50 bytes a ray. Throws
/// InvalidHit.
RecordedPicture record_picture(const Scene& scene, const Accelerator& structure,
                               const PrimaryRays& rays, HitBuffer eye,
                               const WhittedOptions& options, HitCheck check);

}  // namespace beambench
