#include "harness/differ/differ.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include "harness/differ/classify.hpp"
#include "harness/differ/judge_ray.hpp"

namespace beambench {
namespace {

constexpr std::uint64_t kEnoughErrors = 64;
constexpr std::uint64_t kSearchBudget = 400'000'000;  // primitive tests
constexpr std::size_t kBatch = 64;                    // rays searched at once, on all cores

double graze_budget(std::uint64_t rays) { return std::max(2.0, 1e-4 * static_cast<double>(rays)); }

/// The judging of one buffer.
class Judge {
 public:
  Judge(const ReferenceHits& reference, const HitBuffer& buffer, std::span<DiffClass> classes)
      : scene_(reference.scene()),
        rays_(reference.rays()),
        hits_(reference.hits()),
        buffer_(buffer),
        classes_(classes),
        tolerance_(tolerance(scene_, rays_.eye())) {
    report_.rays = buffer.size();
    std::fill(classes_.begin(), classes_.end(), DiffClass::kAgree);
    report_.hits = static_cast<std::uint64_t>(
        std::count_if(hits_.begin(), hits_.end(), [](const auto& hit) { return hit.has_value(); }));
  }

  DiffReport against_oracle() {
    std::vector<std::size_t> disputed;
    for (std::size_t i = 0; i < buffer_.size(); ++i) {
      if (agrees_at_once(i)) continue;
      Mismatch found = mismatch(i);
      if (settle_by_rules(scene_, tolerance_, found)) {
        record(found);
      } else {
        disputed.push_back(i);
      }
    }
    agree_with_the_rest(disputed.size());
    adjudicate(disputed);
    return finish(judge_counts());
  }

  DiffReport as_baseline() {
    for (std::size_t i = 0; i < buffer_.size(); ++i) {
      if (is_miss(i)) continue;
      Mismatch found = mismatch(i);
      settle_as_baseline(found);
      record(found);
    }
    const bool silent = report_.count(DiffClass::kEngineError) == 0;
    return finish(silent ? Verdict::kBaseline : Verdict::kMismatch);
  }

 private:
  Hit answer(std::size_t i) const { return {buffer_.t()[i], buffer_.primitive()[i]}; }
  bool is_miss(std::size_t i) const { return answer(i) == Hit{kInfinity, kNoPrimitive}; }

  Ray ray(std::size_t i) const {
    const auto samples = static_cast<std::size_t>(rays_.samples());
    const auto width = static_cast<std::size_t>(rays_.width());
    return rays_.ray(static_cast<int>(i / samples % width), static_cast<int>(i / samples / width),
                     static_cast<int>(i % samples));
  }

  /// Nearly every ray of a right structure ends here: the same primitive, and so near that the
  /// angle of incidence does not matter.
  bool agrees_at_once(std::size_t i) const {
    const Hit hit = answer(i);
    if (!hits_[i]) return is_miss(i);
    if (hit.primitive != hits_[i]->primitive) return false;
    const double apart = std::abs(static_cast<double>(hit.t) - hits_[i]->t);
    const glm::dvec3 direction(ray(i).direction);
    return hit.t >= 0.0F &&
           apart * apart * glm::dot(direction, direction) <= tolerance_ * tolerance_;
  }

  Mismatch mismatch(std::size_t i) const { return ask_again(rays_, buffer_, i, hits_[i]); }

  void agree_with_the_rest(std::size_t disputed) {
    std::uint64_t others = disputed;
    for (const std::uint64_t count : report_.counts) others += count;
    report_.counts[static_cast<std::size_t>(DiffClass::kAgree)] += report_.rays - others;
  }

  /// Rule 4, batch by batch, so that the outcome does not depend on the number of threads.
  void adjudicate(const std::vector<std::size_t>& disputed) {
    std::uint64_t tests = 0;
    std::vector<Mismatch> batch;
    for (std::size_t first = 0; first < disputed.size(); first += kBatch) {
      const std::size_t last = std::min(first + kBatch, disputed.size());
      batch.clear();
      for (std::size_t i = first; i < last; ++i) batch.push_back(mismatch(disputed[i]));
      if (report_.count(DiffClass::kEngineError) < kEnoughErrors && tests < kSearchBudget) {
        tbb::parallel_for(std::size_t{0}, batch.size(), [&](std::size_t i) {
          beambench::adjudicate(scene_, tolerance_, batch[i]);
        });
        tests += batch.size() * (scene_.triangles.size() + scene_.primitives.size());
      } else {
        for (Mismatch& found : batch) presume_error(found);
      }
      for (const Mismatch& found : batch) record(found);
    }
  }

  static void presume_error(Mismatch& found) {
    found.diff_class = DiffClass::kEngineError;
    found.reason = "disputed, and not searched since enough errors or tests were counted before";
  }

  void record(const Mismatch& found) {
    std::uint64_t& count = report_.counts[static_cast<std::size_t>(found.diff_class)];
    if (found.diff_class != DiffClass::kAgree && count < DiffReport::kMaxExamples) {
      report_.examples.push_back(found);
    }
    ++count;
    if (!classes_.empty()) classes_[found.index] = found.diff_class;
  }

  Verdict judge_counts() const {
    if (report_.count(DiffClass::kEngineError) > 0) return Verdict::kMismatch;
    const auto grazes = static_cast<double>(report_.count(DiffClass::kGraze));
    return grazes > graze_budget(report_.rays) ? Verdict::kGrazes : Verdict::kOk;
  }

  DiffReport finish(Verdict verdict) {
    // Errors of the structure first, then the oracle's, grazes and ties; by pixel within a class.
    const auto rank = [](const Mismatch& m) {
      return m.diff_class == DiffClass::kEngineError ? -10 : -static_cast<int>(m.diff_class);
    };
    std::stable_sort(report_.examples.begin(), report_.examples.end(),
                     [&](const Mismatch& a, const Mismatch& b) { return rank(a) < rank(b); });
    report_.verdict = verdict;
    return std::move(report_);
  }

  const Scene& scene_;
  const PrimaryRays& rays_;
  std::span<const std::optional<ExactHit>> hits_;
  const HitBuffer& buffer_;
  std::span<DiffClass> classes_;
  double tolerance_;
  DiffReport report_;
};

}  // namespace

std::string_view to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::kOk:
      return "ok";
    case Verdict::kMismatch:
      return "mismatch";
    case Verdict::kGrazes:
      return "grazes";
    case Verdict::kBaseline:
      return "baseline";
  }
  return "unknown";
}

DiffReport judge(const ReferenceHits& reference, const HitBuffer& buffer, Conformance conformance,
                 std::span<DiffClass> classes) {
  if (buffer.width() != reference.rays().width() || buffer.height() != reference.rays().height() ||
      buffer.samples() != reference.rays().samples()) {
    throw std::logic_error(fmt::format("a buffer of {}x{}x{} is judged by rays of {}x{}x{}",
                                       buffer.width(), buffer.height(), buffer.samples(),
                                       reference.rays().width(), reference.rays().height(),
                                       reference.rays().samples()));
  }
  if (!classes.empty() && classes.size() != buffer.size()) {
    throw std::logic_error("the classes of an image need one place for each ray");
  }
  Judge judging(reference, buffer, classes);
  return conformance == Conformance::kBaseline ? judging.as_baseline() : judging.against_oracle();
}

}  // namespace beambench
