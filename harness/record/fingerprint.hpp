#pragma once
// 64-bit fingerprints (XXH3) of what was asked, answered and named.

#include <cstdint>
#include <string>
#include <string_view>

#include "accel/hit_buffer.hpp"
#include "accel/primary_rays.hpp"

namespace beambench {

std::uint64_t fingerprint(std::string_view bytes);

/// Of all rays in the order of the buffer: origin, t_min, direction and t_max, bit for bit.
std::uint64_t fingerprint(const PrimaryRays& rays);

/// Of all hits, t and primitive, bit for bit.
std::uint64_t fingerprint(const HitBuffer& buffer);

/// Sixteen hexadecimal digits, as records show fingerprints.
std::string hex_digits(std::uint64_t value);

}  // namespace beambench
