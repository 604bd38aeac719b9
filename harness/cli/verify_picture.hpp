#pragma once
// Judging structures by a whole picture: every ray that each of them was asked for it.

#include <vector>

#include "harness/cli/verification.hpp"
#include "harness/rays/ray_choice.hpp"

namespace beambench {

/// As `verify_scene`, for `whitted` rays. Bit-exact structures must draw the same picture;
/// `different_bits` counts pixels.
std::vector<VerifiedCell> verify_picture(const Scene& scene, const ImageOfRays& image,
                                         const RayChoice& choice,
                                         std::vector<StructureChoice> contenders,
                                         Progress& progress);

}  // namespace beambench
