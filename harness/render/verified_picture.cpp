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

class PictureJudge {
 public:
  PictureJudge(const scenes::Scene& scene, accel::Conformance conformance)
      : scene_(scene), conformance_(conformance) {}

  void judge_eye(const verify::ReferenceHits& reference, accel::HitBuffer hits) {
    judged_.push_back(
        {"eye", reference.input(),
         verify::judge(reference, rays::TraceResults(std::move(hits)), conformance_)});
  }

  void judge_following(std::string_view kind, AskedRays asked) {
    judge_list(kind, rays::Query::kClosestHit, std::move(asked.closest), buffer_of(asked.hits));
    judge_list(kind, rays::Query::kAnyHit, std::move(asked.any), std::move(asked.any_hits));
  }

  std::vector<JudgedRays> take() && { return std::move(judged_); }

 private:
  void judge_list(std::string_view kind, rays::Query query, std::vector<accel::Ray> rays,
                  const rays::TraceResults& results) {
    if (rays.empty()) return;
    const verify::ReferenceHits reference(
        scene_,
        rays::TraceInput(rays::RaySet{std::string(kind), query, 0, std::nullopt, std::move(rays)}));
    judged_.push_back({kind, reference.input(), verify::judge(reference, results, conformance_)});
  }

  const scenes::Scene& scene_;
  accel::Conformance conformance_;
  std::vector<JudgedRays> judged_;
};

verify::Verdict worse(verify::Verdict a, verify::Verdict b) {
  for (const verify::Verdict verdict : {verify::Verdict::kMismatch, verify::Verdict::kGrazes}) {
    if (a == verdict || b == verdict) return verdict;
  }
  return a;
}

}  // namespace

RecordedPicture record_picture(const scenes::Scene& scene, const accel::Accelerator& structure,
                               const accel::PrimaryRays& rays, accel::HitBuffer eye,
                               const WhittedOptions& options, rays::HitCheck check) {
  RecordedPicture picture{std::move(eye), {}, Image(rays.width(), rays.height()), {}};
  auto& [reflected_rays, refracted_rays, shadow_rays] = picture.asked;
  const RecordedQueries reflected(structure, reflected_rays);
  const RecordedQueries refracted(structure, refracted_rays);
  const RecordedQueries shadow(structure, shadow_rays);
  const Whitted tracer(scene, {&reflected, &refracted, &shadow}, options, std::move(check));
  picture.census = draw_in_order(tracer, eye_rays(rays), picture.eye, picture.image);
  return picture;
}

std::vector<JudgedRays> judge_picture(const verify::ReferenceHits& eye, RecordedPicture picture,
                                      accel::Conformance conformance) {
  PictureJudge judge(eye.scene(), conformance);
  judge.judge_eye(eye, std::move(picture.eye));
  for (std::size_t i = 0; i < kFollowingRays; ++i) {
    judge.judge_following(kFollowingRayNames[i], std::move(picture.asked[i]));
  }
  return std::move(judge).take();
}

verify::DiffReport sum_of(const std::vector<JudgedRays>& judged) {
  verify::DiffReport sum;
  sum.verdict = judged.front().report.verdict;
  for (const JudgedRays& rays : judged) {
    sum.rays += rays.report.rays;
    sum.hits += rays.report.hits;
    for (std::size_t i = 0; i < sum.counts.size(); ++i) sum.counts[i] += rays.report.counts[i];
    sum.verdict = worse(sum.verdict, rays.report.verdict);
  }
  return sum;
}

}  // namespace beambench::render
