#pragma once
// 64-bit fingerprints (XXH3) of rays, results and strings.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "harness/rays/trace_results.hpp"

namespace beambench::rays {

std::uint64_t fingerprint(std::string_view bytes);

/// Returns the fingerprint of all rays in order: origin, t_min, direction and t_max, bit for bit.
std::uint64_t fingerprint(std::span<const accel::Ray> rays);
std::uint64_t fingerprint(const accel::PrimaryRays& rays);
std::uint64_t fingerprint(const TraceInput& input);

/// Computes the fingerprint of a list whose rays arrive in parts.
class RayFingerprint {
 public:
  RayFingerprint();
  ~RayFingerprint();
  RayFingerprint(const RayFingerprint&) = delete;
  RayFingerprint& operator=(const RayFingerprint&) = delete;

  void add(std::span<const accel::Ray> rays);
  /// Returns the fingerprint of all rays so far.
  std::uint64_t value() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Returns the fingerprint of all hits, t and primitive, bit for bit.
std::uint64_t fingerprint(const accel::HitBuffer& buffer);
std::uint64_t fingerprint(const TraceResults& results);

/// Returns a fingerprint as sixteen hexadecimal digits, as in records.
std::string hex_digits(std::uint64_t value);

}  // namespace beambench::rays
