#include "harness/render/verified_picture.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "harness/render/whitted_picture.hpp"
#include "harness/verify/describe.hpp"
#include "scenes/base/error.hpp"

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

/// Requires a bit-exact structure to draw the same picture as the first bit-exact one.
void compare_bits(const Image& image, const std::string& first_label, const Image& first,
                  verify::VerifiedCell& cell) {
  cell.bits_reference = first_label;
  for (std::size_t i = 0; i < image.pixels().size(); ++i) {
    if (image.pixels()[i] != first.pixels()[i]) ++cell.different_bits;
  }
  if (cell.different_bits == 0) return;
  cell.disputes.push_back(fmt::format(
      "{} of {} pixels differ from those of {}; a bit-exact structure must draw the same\n",
      cell.different_bits, image.pixels().size(), first_label));
}

}  // namespace

void RecordedQueries::closest_hits(const accel::RaySource& rays, const accel::HitSpan& hits,
                                   const accel::QueryContext& context) const {
  structure().closest_hits(rays, hits, context);
  rays.for_each([&](std::size_t i, const accel::Ray& ray) {
    asked_->closest.push_back(ray);
    asked_->hits.push_back(hits.get(i));
  });
}
void RecordedQueries::any_hits(const accel::RaySource& rays, std::span<std::uint8_t> hits,
                               const accel::QueryContext& context) const {
  structure().any_hits(rays, hits, context);
  rays.for_each([&](std::size_t i, const accel::Ray& ray) {
    asked_->any.push_back(ray);
    asked_->any_hits.push_back(hits[i]);
  });
}

void ReplayedResults::closest_hits(const accel::RaySource& rays, const accel::HitSpan& hits,
                                   const accel::QueryContext&) const {
  for (std::size_t i = 0; i < rays.size(); ++i) hits.set(i, *hit_++);
}
void ReplayedResults::any_hits(const accel::RaySource& rays, std::span<std::uint8_t> hits,
                               const accel::QueryContext&) const {
  std::copy_n(any_hit_, rays.size(), hits.begin());
  any_hit_ += rays.size();
}

RecordedPicture record_picture(const std::shared_ptr<const ShadedScene>& scene,
                               const accel::Accelerator& structure, const accel::PrimaryRays& rays,
                               accel::HitBuffer primary, const WhittedOptions& options,
                               rays::HitCheck check) {
  RecordedPicture picture{std::move(primary), {}, Image(rays.width(), rays.height()), {}};
  auto& [reflected_rays, refracted_rays, shadow_rays] = picture.asked;
  const RecordedQueries reflected(structure, reflected_rays);
  const RecordedQueries refracted(structure, refracted_rays);
  const RecordedQueries shadow(structure, shadow_rays);
  const Whitted tracer(scene, {&reflected, &refracted, &shadow}, options, std::move(check));
  picture.census = draw_in_order(tracer, rays, picture.primary, picture.image);
  return picture;
}

void require_support(const accel::StructureChoice& choice) {
  const accel::Support& support = choice.info().support;
  if (support.images && support.batches && support.single_rays) return;
  throw accel::UnsupportedError(
      fmt::format("'{}' does not trace all rays of a picture: an image, lists and single rays",
                  choice.info().name));
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
          primary.scene(),
          rays::TraceInput(rays::RaySet{{std::move(rays)}, std::string(kind), query}));
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

std::vector<verify::VerifiedCell> verify_picture(const scenes::Scene& scene,
                                                 const rays::ImageOfRays& image,
                                                 const rays::RayChoice& choice,
                                                 std::vector<accel::StructureChoice> contenders,
                                                 base::Progress& progress) {
  const accel::PrimaryRays rays = image.rays();
  const WhittedOptions options = whitted_options(choice);
  const verify::ReferenceHits camera_hits(scene, rays);
  const auto shaded = std::make_shared<const ShadedScene>(scene);
  std::optional<std::pair<std::string, Image>> bits;  // of the first bit-exact structure
  return verify::verify_each(
      scene, choice.label, std::move(contenders), progress,
      [&](const accel::StructureChoice& contender, verify::VerifiedCell& cell) {
        require_support(contender);
        const auto structure = contender.build(scene, {image.camera, rays.count()});
        accel::HitBuffer hits(rays.width(), rays.height(), rays.samples());
        structure->closest_hits(rays, hits, {});
        RecordedPicture picture = record_picture(shaded, *structure, rays, std::move(hits), options,
                                                 rays::HitCheck(scene, contender));
        const accel::Conformance conformance = contender.info().conformance;
        if (conformance == accel::Conformance::kBitExact && bits) {
          compare_bits(picture.image, bits->first, bits->second, cell);
        } else if (conformance == accel::Conformance::kBitExact) {
          bits.emplace(cell.label, picture.image);
        }
        const auto verified = verify_recorded_picture(camera_hits, std::move(picture), conformance);
        cell.report = sum_of(verified);
        if (cell.different_bits > 0) cell.report->verdict = verify::Verdict::kMismatch;
        cell.verdict = cell.report->verdict;
        for (std::string& dispute : described_examples(scene, verified)) {
          cell.disputes.push_back(std::move(dispute));
        }
      });
}

std::vector<std::string> described_examples(const scenes::Scene& scene,
                                            const std::vector<VerifiedRays>& verified) {
  std::vector<std::string> examples;
  for (const VerifiedRays& rays : verified) {
    if (verify::is_right(rays.report.verdict)) continue;
    for (const verify::Mismatch& example : rays.report.examples) {
      examples.push_back(
          fmt::format("{} rays, {}", rays.kind, verify::describe(scene, rays.input, example)));
    }
  }
  return examples;
}

}  // namespace beambench::render
