#include "harness/rays/fingerprint.hpp"

#include <vector>

#include <fmt/format.h>
#include <xxhash.h>

namespace beambench::rays {

static_assert(sizeof(accel::Ray) == 8 * sizeof(float), "rays are hashed as bytes: no padding");

std::uint64_t fingerprint(std::string_view bytes) {
  return XXH3_64bits(bytes.data(), bytes.size());
}

std::uint64_t fingerprint(std::span<const accel::Ray> rays) {
  return XXH3_64bits(rays.data(), rays.size_bytes());
}

struct RayFingerprint::State {
  struct Free {
    void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
  };
  std::unique_ptr<XXH3_state_t, Free> hash{XXH3_createState()};
};

RayFingerprint::RayFingerprint() : state_(std::make_unique<State>()) {
  XXH3_64bits_reset(state_->hash.get());
}
RayFingerprint::~RayFingerprint() = default;

void RayFingerprint::add(std::span<const accel::Ray> rays) {
  XXH3_64bits_update(state_->hash.get(), rays.data(), rays.size_bytes());
}

std::uint64_t RayFingerprint::value() const { return XXH3_64bits_digest(state_->hash.get()); }

std::uint64_t fingerprint(const accel::PrimaryRays& rays) {
  std::uint64_t hash = 0;
  std::vector<accel::Ray> row;
  for (int y = 0; y < rays.height(); ++y) {
    row.clear();
    rays.for_each(y, y + 1, [&](std::size_t, const accel::Ray& ray) { row.push_back(ray); });
    // Each row's hash is seeded with the hash so far, so the whole image is never in memory.
    hash = XXH3_64bits_withSeed(row.data(), row.size() * sizeof(accel::Ray), hash);
  }
  return hash;
}

std::uint64_t fingerprint(const accel::HitBuffer& buffer) {
  const std::uint64_t distances = XXH3_64bits(buffer.t(), buffer.size() * sizeof(float));
  return XXH3_64bits_withSeed(buffer.primitive(), buffer.size() * sizeof(scenes::PrimitiveId),
                              distances);
}

std::uint64_t fingerprint(const TraceInput& input) {
  return input.list() != nullptr ? fingerprint(input.list()->rays) : fingerprint(*input.image());
}

std::uint64_t fingerprint(const TraceResults& results) {
  if (const auto* any = std::get_if<AnyHits>(&results))
    return XXH3_64bits(any->data(), any->size());
  return fingerprint(std::get<accel::HitBuffer>(results));
}

std::string hex_digits(std::uint64_t value) { return fmt::format("{:016x}", value); }

}  // namespace beambench::rays
