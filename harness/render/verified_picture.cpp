#include "harness/render/verified_picture.hpp"

#include <utility>

#include "harness/render/whitted_picture.hpp"

namespace beambench::render {
namespace {

accel::HitBuffer buffer_of(const std::vector<std::optional<accel::Hit>>& hits) {
  accel::HitBuffer buffer(static_cast<int>(hits.size()), 1, 1);
  for (std::size_t i = 0; i < hits.size(); ++i) buffer.set(i, hits[i]);
  return buffer;
}

verify::Verdict worse(verify::Verdict a, verify::Verdict b) {
  for (const verify::Verdict verdict : {verify::Verdict::kMismatch, verify::Verdict::kGrazes}) {
    if (a == verdict || b == verdict) return verdict;
  }
  return a;
}

}  // namespace

RecordedPicture record_picture(const scenes::Scene& scene, const accel::Accelerator& structure,
                               const accel::PrimaryRays& rays, accel::HitBuffer primary,
                               const WhittedOptions& options, rays::HitCheck check) {
  RecordedPicture picture{std::move(primary), {}, Image(rays.width(), rays.height()), {}};
  auto& [reflected_rays, refracted_rays, shadow_rays] = picture.asked;
  const RecordedQueries reflected(structure, reflected_rays);
  const RecordedQueries refracted(structure, refracted_rays);
  const RecordedQueries shadow(structure, shadow_rays);
  const Whitted tracer(scene, {&reflected, &refracted, &shadow}, options, std::move(check));
  picture.census = draw_in_order(tracer, camera_rays(rays), picture.primary, picture.image);
  return picture;
}

std::vector<VerifiedRays> verify_recorded_picture(const verify::ReferenceHits& primary,
                                                  RecordedPicture picture,
                                                  accel::Conformance conformance) {
  std::vector<VerifiedRays> verified{
      {"camera", primary.input(),
       verify::verify_results(primary, rays::TraceResults(std::move(picture.primary)),
                              conformance)}};
  for (std::size_t i = 0; i < kFollowingRays; ++i) {
    const std::string_view kind = kFollowingRayNames[i];
    const auto add = [&](rays::Query query, std::vector<accel::Ray> rays,
                         const rays::TraceResults& results) {
      if (rays.empty()) return;
      const verify::ReferenceHits reference(
          primary.scene(), rays::TraceInput(rays::RaySet{std::string(kind), query, 0, std::nullopt,
                                                         std::move(rays)}));
      verified.push_back(
          {kind, reference.input(), verify::verify_results(reference, results, conformance)});
    };
    AskedRays& asked = picture.asked[i];
    add(rays::Query::kClosestHit, std::move(asked.closest), buffer_of(asked.hits));
    add(rays::Query::kAnyHit, std::move(asked.any), std::move(asked.any_hits));
  }
  return verified;
}

verify::DiffReport sum_of(const std::vector<VerifiedRays>& verified) {
  verify::DiffReport sum;
  sum.verdict = verified.front().report.verdict;
  for (const VerifiedRays& rays : verified) {
    sum.rays += rays.report.rays;
    sum.hits += rays.report.hits;
    for (std::size_t i = 0; i < sum.counts.size(); ++i) sum.counts[i] += rays.report.counts[i];
    sum.verdict = worse(sum.verdict, rays.report.verdict);
  }
  return sum;
}

}  // namespace beambench::render
