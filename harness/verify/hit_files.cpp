#include "harness/verify/hit_files.hpp"

#include <span>
#include <utility>

#include <fmt/format.h>

#include "harness/rays/hit_file.hpp"
#include "harness/rays/ray_file.hpp"
#include "harness/rays/trace_input.hpp"
#include "scenes/base/error.hpp"

namespace beambench::verify {
namespace {

constexpr std::size_t kRaysAtOnce = std::size_t{1} << 18U;  // rays in memory at once

[[noreturn]] void refuse_counts(const std::filesystem::path& rays, std::uint64_t ray_count,
                                const std::filesystem::path& hits, const std::string& hit_count) {
  throw InputError(
      fmt::format("{}: there are {} hits for the {} rays of {}; write one for each ray, "
                  "in their order",
                  hits.string(), hit_count, ray_count, rays.string()));
}

}  // namespace

ClaimsReport verify_hit_files(const scenes::Scene& scene, const std::filesystem::path& rays,
                              const std::filesystem::path& hits,
                              ClaimVerifier::OnMismatch on_mismatch, base::Progress& progress,
                              bool must_hit) {
  rays::RayReader ray_reader(rays);
  rays::require_made_for(scene, ray_reader.header());
  rays::HitReader hit_reader(hits);
  const auto known_rays = ray_reader.count();
  const auto known_hits = hit_reader.count();
  if (known_rays && known_hits && *known_rays != *known_hits) {
    refuse_counts(rays, *known_rays, hits, fmt::format("{}", *known_hits));
  }

  ClaimVerifier verifier(scene, std::move(on_mismatch));
  rays::RaySet header = ray_reader.header();
  header.must_hit |= must_hit;
  verifier.judge_as(header);
  std::vector<accel::Ray> block(kRaysAtOnce);
  rays::HitTable table;
  std::uint64_t verified = 0;
  for (;;) {
    const std::size_t ray_count = ray_reader.read(block);
    // One more than the number of rays, to detect excess hits.
    const std::size_t hit_count =
        hit_reader.read(ray_count < kRaysAtOnce ? ray_count + 1 : ray_count, table);
    if (hit_count < ray_count) {
      // The remaining rays are counted for the message.
      std::uint64_t all = verified + ray_count;
      while (const std::size_t more = ray_reader.read(block)) all += more;
      refuse_counts(rays, all, hits, fmt::format("{}", verified + hit_count));
    }
    if (hit_count > ray_count) {
      refuse_counts(rays, verified + ray_count, hits,
                    fmt::format("more than {}", verified + ray_count));
    }
    if (ray_count == 0) break;
    try {
      verifier.add(std::span(block).first(ray_count), table.view());
    } catch (const InvalidClaim& error) {
      throw InputError(fmt::format("{}: hit {}: {}", hit_reader.place_of(error.index), error.index,
                                   error.what()));
    }
    verified += ray_count;
    progress.advance(ray_reader.part());
    if (ray_count < kRaysAtOnce) break;
  }

  ClaimsReport found{hit_reader.query(), verifier.finish(), {}};
  for (const Mismatch& example : found.report.examples) {
    found.places.push_back(
        fmt::format("ray {} ({})", example.index, hit_reader.place_of(example.index)));
  }
  return found;
}

ClaimsReport verify_traced_file(const scenes::Scene& scene, const std::filesystem::path& rays,
                                const Tracer& tracer, ClaimVerifier::OnMismatch on_mismatch,
                                bool must_hit) {
  rays::RaySet set = rays::read_ray_file(rays);
  set.must_hit |= must_hit;
  rays::require_made_for(scene, set);
  const rays::HitTable hits = tracer(scene, rays::TraceInput(set));
  ClaimVerifier verifier(scene, std::move(on_mismatch));
  verifier.judge_as(set);
  try {
    verifier.add(set.rays, hits.view());
  } catch (const InvalidClaim& error) {
    throw InputError(
        fmt::format("{}: the hit of ray {}: {}", rays.string(), error.index, error.what()));
  }
  const bool any = !hits.occluded.empty();
  ClaimsReport found{any ? rays::Query::kAnyHit : rays::Query::kClosestHit, verifier.finish(), {}};
  for (const Mismatch& example : found.report.examples) {
    found.places.push_back(fmt::format("ray {}", example.index));
  }
  return found;
}

}  // namespace beambench::verify
