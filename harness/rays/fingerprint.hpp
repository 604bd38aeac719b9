#pragma once
// 64-bit fingerprints (XXH3) of rays, results and texts.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "harness/rays/trace_results.hpp"

namespace beambench::rays {

std::uint64_t fingerprint(std::string_view bytes);

/// Of all rays in their order: origin, t_min, direction and t_max, bit for bit.
std::uint64_t fingerprint(std::span<const accel::Ray> rays);
std::uint64_t fingerprint(const accel::PrimaryRays& rays);
std::uint64_t fingerprint(const TraceInput& input);

/// The fingerprint of a list that comes in parts.
class RayFingerprint {
 public:
  RayFingerprint();
  ~RayFingerprint();
  RayFingerprint(const RayFingerprint&) = delete;
  RayFingerprint& operator=(const RayFingerprint&) = delete;

  void add(std::span<const accel::Ray> rays);
  /// Of all rays so far.
  std::uint64_t value() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Of all hits, t and primitive, bit for bit.
std::uint64_t fingerprint(const accel::HitBuffer& buffer);
std::uint64_t fingerprint(const TraceResults& results);

/// Sixteen hexadecimal digits, as records show fingerprints.
std::string hex_digits(std::uint64_t value);

}  // namespace beambench::rays
