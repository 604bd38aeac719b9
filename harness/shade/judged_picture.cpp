#include "harness/shade/judged_picture.hpp"

#include <utility>

namespace beambench {
namespace {

HitBuffer buffer_of(const std::vector<std::optional<Hit>>& hits) {
  HitBuffer buffer(static_cast<int>(hits.size()), 1, 1);
  for (std::size_t i = 0; i < hits.size(); ++i) buffer.set(i, hits[i]);
  return buffer;
}

class PictureJudge {
 public:
  PictureJudge(const Scene& scene, Conformance conformance)
      : scene_(scene), conformance_(conformance) {}

  void judge_eye(const ReferenceHits& reference, HitBuffer hits) {
    judged_.push_back(
        {"eye", reference.question(), judge(reference, Answers(std::move(hits)), conformance_)});
  }

  void judge_following(std::string_view kind, AskedRays asked) {
    judge_list(kind, Query::kClosestHit, std::move(asked.closest), buffer_of(asked.hits));
    judge_list(kind, Query::kAnyHit, std::move(asked.any), std::move(asked.any_hits));
  }

  std::vector<JudgedRays> take() && { return std::move(judged_); }

 private:
  void judge_list(std::string_view kind, Query query, std::vector<Ray> rays,
                  const Answers& answers) {
    if (rays.empty()) return;
    const ReferenceHits reference(
        scene_, Question(RaySet{std::string(kind), query, 0, std::nullopt, std::move(rays)}));
    judged_.push_back({kind, reference.question(), judge(reference, answers, conformance_)});
  }

  const Scene& scene_;
  Conformance conformance_;
  std::vector<JudgedRays> judged_;
};

Verdict worse(Verdict a, Verdict b) {
  for (const Verdict verdict : {Verdict::kMismatch, Verdict::kGrazes}) {
    if (a == verdict || b == verdict) return verdict;
  }
  return a;
}

}  // namespace

std::vector<JudgedRays> judge_picture(const ReferenceHits& eye, RecordedPicture picture,
                                      Conformance conformance) {
  PictureJudge judge(eye.scene(), conformance);
  judge.judge_eye(eye, std::move(picture.eye));
  for (std::size_t i = 0; i < kFollowingRays; ++i) {
    judge.judge_following(kFollowingRayNames[i], std::move(picture.asked[i]));
  }
  return std::move(judge).take();
}

DiffReport sum_of(const std::vector<JudgedRays>& judged) {
  DiffReport sum;
  sum.verdict = judged.front().report.verdict;
  for (const JudgedRays& rays : judged) {
    sum.rays += rays.report.rays;
    sum.hits += rays.report.hits;
    for (std::size_t i = 0; i < sum.counts.size(); ++i) sum.counts[i] += rays.report.counts[i];
    sum.verdict = worse(sum.verdict, rays.report.verdict);
  }
  return sum;
}

}  // namespace beambench
