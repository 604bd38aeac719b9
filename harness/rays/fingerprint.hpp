#pragma once
// 64-bit fingerprints (XXH3) of what was asked, answered and named.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "harness/rays/answers.hpp"

namespace beambench::rays {

std::uint64_t fingerprint(std::string_view bytes);

/// Of all rays in their order: origin, t_min, direction and t_max, bit for bit.
std::uint64_t fingerprint(std::span<const accel::Ray> rays);
std::uint64_t fingerprint(const accel::PrimaryRays& rays);
std::uint64_t fingerprint(const Question& question);

/// Of all hits, t and primitive, bit for bit.
std::uint64_t fingerprint(const accel::HitBuffer& buffer);
std::uint64_t fingerprint(const Answers& answers);

/// Sixteen hexadecimal digits, as records show fingerprints.
std::string hex_digits(std::uint64_t value);

}  // namespace beambench::rays
