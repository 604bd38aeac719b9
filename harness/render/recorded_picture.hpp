#pragma once
// A picture with all that a structure was asked for it.

#include <array>
#include <cstddef>
#include <string_view>

#include "accel/core/hit_buffer.hpp"
#include "accel/core/primary_rays.hpp"
#include "harness/render/picture/image.hpp"
#include "harness/render/watched_queries.hpp"
#include "harness/render/whitted.hpp"

namespace beambench::render {

/// The kinds of rays that follow the eye's.
enum class FollowingRays : std::size_t { kReflected, kRefracted, kShadow, kCount };
inline constexpr auto kFollowingRays = static_cast<std::size_t>(FollowingRays::kCount);
template <class Value>
using ByFollowingRays = std::array<Value, kFollowingRays>;
inline constexpr ByFollowingRays<std::string_view> kFollowingRayNames{"reflected", "refracted",
                                                                      "shadow"};

struct RecordedPicture {
  accel::HitBuffer eye;  ///< what the eye's rays found
  ByFollowingRays<AskedRays> asked;
  Image image;
  RayCensus census;
};

/// Draws the picture that `eye` begins, on this thread alone; some 50 bytes a ray. Throws
/// InvalidHit.
RecordedPicture record_picture(const scenes::Scene& scene, const accel::Accelerator& structure,
                               const accel::PrimaryRays& rays, accel::HitBuffer eye,
                               const WhittedOptions& options, rays::HitCheck check);

}  // namespace beambench::render
