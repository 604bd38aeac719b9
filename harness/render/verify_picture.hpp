#pragma once
// Verifying structures by a whole picture: every ray that each of them traced for it.

#include <vector>

#include "harness/rays/ray_kind.hpp"
#include "harness/verify/verification.hpp"

namespace beambench::render {

/// As `verify_scene`, for `whitted` rays. Bit-exact structures must draw the same picture;
/// `different_bits` counts pixels.
std::vector<verify::VerifiedCell> verify_picture(const scenes::Scene& scene,
                                                 const rays::ImageOfRays& image,
                                                 const rays::RayChoice& choice,
                                                 std::vector<accel::StructureChoice> contenders,
                                                 base::Progress& progress);

}  // namespace beambench::render
