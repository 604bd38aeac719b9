#pragma once
// Judging structures by a whole picture: every ray that each of them was asked for it.

#include <vector>

#include "harness/cli/verification.hpp"
#include "harness/rays/ray_kind.hpp"

namespace beambench::cli {

/// As `verify_scene`, for `whitted` rays. Bit-exact structures must draw the same picture;
/// `different_bits` counts pixels.
std::vector<VerifiedCell> verify_picture(const scenes::Scene& scene, const rays::ImageOfRays& image,
                                         const rays::RayChoice& choice,
                                         std::vector<accel::StructureChoice> contenders,
                                         base::Progress& progress);

}  // namespace beambench::cli
