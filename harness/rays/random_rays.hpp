#pragma once
// Uniform lines through a box.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "accel/core/ray.hpp"
#include "scenes/bounds.hpp"

namespace beambench::rays {

/// `count` rays that are uniform among all lines through the box, by the measure of lines that does
/// not change when space is moved or turned (Santalo, Integral Geometry, 1976, II.12): they enter
/// at points uniform on its surface, with density cos / pi about the inward normal. The probability
/// to meet a convex body in the box is then its surface area over the box's. They start one
/// diagonal before the box, with directions of unit length. The box is widened by 2^-10 of its
/// diagonal, so that it has an inside. None for an empty box.
std::vector<accel::Ray> random_rays(const scenes::Bounds& box, std::size_t count,
                                    std::uint64_t seed);

}  // namespace beambench::rays
