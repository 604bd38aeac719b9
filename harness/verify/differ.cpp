#include "harness/verify/differ.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include "harness/verify/tolerance.hpp"
#include "harness/verify/verify_ray.hpp"

namespace beambench::verify {
namespace {

constexpr std::uint64_t kEnoughErrors = 64;
constexpr std::uint64_t kTestBudget = 400'000'000;  // primitive tests
constexpr std::size_t kBatch = 64;                  // rays searched at once, on all cores

/// Runs a parallel loop on all cores in the caller's floating-point mode. By default, it would run
/// in the mode of the thread's first loop, which may be Embree's, where denormals count as 0.
template <class Range, class Body>
void on_all_cores(const Range& range, const Body& body) {
  tbb::task_group_context mode(
      tbb::task_group_context::bound,
      tbb::task_group_context::default_traits | tbb::task_group_context::fp_settings);
  tbb::parallel_for(range, body, mode);
}

double graze_budget(std::uint64_t rays) { return std::max(2.0, 1e-4 * static_cast<double>(rays)); }

std::array<std::size_t, 3> shape_of(const rays::TraceResults& results) {
  if (const auto* any = std::get_if<rays::AnyHits>(&results)) return {any->size(), 1, 0};
  const auto& hits = std::get<accel::HitBuffer>(results);
  return {static_cast<std::size_t>(hits.width()), static_cast<std::size_t>(hits.height()),
          static_cast<std::size_t>(hits.samples())};
}

std::array<std::size_t, 3> shape_of(const rays::TraceInput& input) {
  if (input.query() == rays::Query::kAnyHit) return {input.size(), 1, 0};
  const accel::PrimaryRays* image = input.image();
  if (image == nullptr) return {input.size(), 1, 1};
  return {static_cast<std::size_t>(image->width()), static_cast<std::size_t>(image->height()),
          static_cast<std::size_t>(image->samples())};
}

void require_shape(const rays::TraceInput& input, const rays::TraceResults& results) {
  const auto given = shape_of(results);
  const auto expected = shape_of(input);
  if (given == expected) return;
  throw std::logic_error(fmt::format("results of {}x{}x{} are verified by rays of {}x{}x{}",
                                     given[0], given[1], given[2], expected[0], expected[1],
                                     expected[2]));
}

Verdict verdict_of(const DiffReport& report, bool may_graze) {
  if (report.faults() > 0) return Verdict::kMismatch;
  if (may_graze) return Verdict::kOk;
  const auto grazes = static_cast<double>(report.count(DiffClass::kGraze));
  return grazes > graze_budget(report.rays) ? Verdict::kGrazes : Verdict::kOk;
}

/// Ranks errors of the structure first, then leaks, the oracle's errors, grazes and ties.
int rank(const Mismatch& mismatch) {
  if (mismatch.diff_class == DiffClass::kStructureError) return -10;
  return mismatch.leaked ? -9 : -static_cast<int>(mismatch.diff_class);
}

}  // namespace

/// The comparison of one part.
class Differ::Part {
 public:
  Part(Differ& differ, const ReferenceHits& reference, const rays::TraceResults& results,
       std::span<DiffClass> classes, std::span<const std::string_view> faults)
      : differ_(differ),
        scene_(reference.scene()),
        input_(reference.input()),
        hits_(reference.hits()),
        results_(results),
        classes_(classes),
        faults_(faults),
        first_(differ.report_.rays) {
    differ.report_.rays += input_.size();
    differ.report_.hits += reference.hit_count();
    differ.may_graze_ = input_.list() != nullptr && input_.list()->may_graze;
    std::fill(classes_.begin(), classes_.end(), DiffClass::kAgree);
  }

  void against_oracle() {
    std::vector<std::size_t> disputed;
    for (std::size_t i = 0; i < input_.size(); ++i) {
      if (!faults_.empty() && !faults_[i].empty()) {
        record(mismatch_for(i, faults_[i]));
        continue;
      }
      if (agrees_at_once(i)) {
        ++count_of(DiffClass::kAgree);
        continue;
      }
      Mismatch found = mismatch(i);
      if (classify_by_oracle(scene_, found)) {
        record(found);
      } else {
        disputed.push_back(i);
      }
    }
    search(disputed);
  }

  void as_baseline() {
    for (std::size_t i = 0; i < input_.size(); ++i) {
      if (is_miss_of(i)) continue;
      Mismatch found = mismatch(i);
      classify_as_baseline(found);
      record(found);
    }
  }

 private:
  static accel::Hit answer(const accel::HitBuffer& hits, std::size_t i) {
    return {hits.t()[i], hits.primitive()[i]};
  }
  static bool is_miss(const accel::Hit& hit) {
    return hit == accel::Hit{accel::kInfinity, scenes::kNoPrimitive};
  }

  bool is_miss_of(std::size_t i) const {
    if (const auto* any = std::get_if<rays::AnyHits>(&results_)) return (*any)[i] == 0;
    return is_miss(answer(std::get<accel::HitBuffer>(results_), i));
  }

  /// Returns whether the result is on the oracle's primitive, so close that the angle of incidence
  /// does not matter: true for nearly every ray of a correct structure.
  bool agrees_at_once(std::size_t i) const {
    if (const auto* any = std::get_if<rays::AnyHits>(&results_)) {
      return (*any)[i] == (hits_[i] ? 1 : 0);
    }
    const accel::Hit hit = answer(std::get<accel::HitBuffer>(results_), i);
    if (!hits_[i]) return is_miss(hit);
    if (hit.primitive != hits_[i]->primitive) return false;
    const double apart = std::abs(static_cast<double>(hit.t) - hits_[i]->t);
    const accel::Ray ray = input_.ray(i);
    return accel::in_interval(ray, hit.t) &&
           apart * glm::length(glm::dvec3(ray.direction)) <= tolerance(ray, hit.t);
  }

  Mismatch mismatch(std::size_t i) const {
    Mismatch found = candidate_mismatch(input_, results_, i, hits_[i]);
    found.index = first_ + i;
    return found;
  }
  Mismatch mismatch_for(std::size_t i, std::string_view fault) const {
    Mismatch found = mismatch(i);
    found.diff_class = DiffClass::kStructureError;
    found.reason = fault;
    return found;
  }

  /// Classifies disputes by exact arithmetic, batch by batch, so that the result does not depend on
  /// the number of threads.
  void search(const std::vector<std::size_t>& disputed) {
    std::vector<Mismatch> batch;
    for (std::size_t first = 0; first < disputed.size(); first += kBatch) {
      const std::size_t last = std::min(first + kBatch, disputed.size());
      batch.clear();
      for (std::size_t i = first; i < last; ++i) batch.push_back(mismatch(disputed[i]));
      if (count_of(DiffClass::kStructureError) < kEnoughErrors &&
          differ_.search_tests_ < kTestBudget) {
        on_all_cores(tbb::blocked_range(batch.begin(), batch.end(), 1), [&](const auto& part) {
          for (Mismatch& found : part) classify_by_search(scene_, found);
        });
        differ_.search_tests_ +=
            batch.size() * (scene_.triangles.size() + scene_.primitives.size());
      } else {
        for (Mismatch& found : batch) presume_error(found);
      }
      for (const Mismatch& found : batch) record(found);
    }
  }

  static void presume_error(Mismatch& found) {
    found.diff_class = DiffClass::kStructureError;
    found.reason =
        "disputed, and not searched because enough errors or tests had already been counted";
  }

  std::uint64_t& count_of(DiffClass diff_class) {
    return differ_.report_.counts[static_cast<std::size_t>(diff_class)];
  }

  void record(const Mismatch& found) {
    DiffReport& report = differ_.report_;
    std::uint64_t& count = count_of(found.diff_class);
    if (found.diff_class != DiffClass::kAgree) {
      const bool may_leak = found.diff_class == DiffClass::kGraze;
      const std::uint64_t alike =
          found.leaked ? report.leaks : count - (may_leak ? report.leaks : 0);
      if (alike < DiffReport::kMaxExamples) report.examples.push_back(found);
      if (differ_.on_mismatch_) differ_.on_mismatch_(found);
    }
    ++count;
    if (found.leaked) ++report.leaks;
    if (!classes_.empty()) classes_[found.index - first_] = found.diff_class;
  }

  Differ& differ_;
  const scenes::Scene& scene_;
  const rays::TraceInput& input_;
  std::span<const std::optional<accel::oracle::ExactHit>> hits_;
  const rays::TraceResults& results_;
  std::span<DiffClass> classes_;
  std::span<const std::string_view> faults_;
  std::size_t first_;
};

std::string_view to_string(Verdict verdict) {
  static constexpr std::array<std::string_view, 7> kNames{
      "ok", "mismatch", "grazes", "baseline", "error", "no_rays", "unsupported"};
  return kNames[static_cast<std::size_t>(verdict)];
}

void Differ::compare(const ReferenceHits& reference, const rays::TraceResults& results,
                     std::span<DiffClass> classes, std::span<const std::string_view> faults) {
  require_shape(reference.input(), results);
  for (const std::size_t size : {classes.size(), faults.size()}) {
    if (size == 0 || size == reference.input().size()) continue;
    throw std::logic_error("classes and faults need one place for each ray");
  }
  Part part(*this, reference, results, classes, faults);
  if (conformance_ == accel::Conformance::kBaseline) {
    part.as_baseline();
  } else {
    part.against_oracle();
  }
}

DiffReport Differ::finish() {
  std::ranges::stable_sort(report_.examples, {}, rank);  // within a class, in order of discovery
  report_.verdict = verdict_of(report_, may_graze_);
  if (conformance_ == accel::Conformance::kBaseline && report_.verdict == Verdict::kOk) {
    report_.verdict = Verdict::kBaseline;
  }
  return std::move(report_);
}

DiffReport verify_results(const ReferenceHits& reference, const rays::TraceResults& results,
                          accel::Conformance conformance, std::span<DiffClass> classes) {
  Differ differ(conformance);
  differ.compare(reference, results, classes);
  return differ.finish();
}

std::vector<std::optional<accel::oracle::ExactHit>> oracle_hits(const accel::oracle::Oracle& oracle,
                                                                const rays::TraceInput& input) {
  std::vector<std::optional<accel::oracle::ExactHit>> hits(input.size());
  on_all_cores(tbb::blocked_range(std::size_t{0}, hits.size(), 1024), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      hits[i] = oracle.closest_hit(input.ray(i));
    }
  });
  return hits;
}

ReferenceHits::ReferenceHits(const scenes::Scene& scene, rays::TraceInput input)
    : scene_(&scene),
      input_(std::move(input)),
      hits_(oracle_hits(accel::oracle::Oracle(scene, input_.reach()), input_)) {}

ReferenceHits::ReferenceHits(const scenes::Scene& scene, rays::TraceInput input,
                             std::vector<std::optional<accel::oracle::ExactHit>> hits)
    : scene_(&scene), input_(std::move(input)), hits_(std::move(hits)) {
  if (hits_.size() != input_.size()) {
    throw std::logic_error(
        fmt::format("{} reference hits are given for {} rays", hits_.size(), input_.size()));
  }
}

accel::HitBuffer ReferenceHits::rounded() const {
  const accel::PrimaryRays& image = *input_.image();
  accel::HitBuffer hits(image.width(), image.height(), image.samples());
  for (std::size_t i = 0; i < hits.size(); ++i) hits.set(i, verify::rounded(hits_[i]));
  return hits;
}

std::uint64_t ReferenceHits::hit_count() const {
  return static_cast<std::uint64_t>(
      std::ranges::count_if(hits_, [](const auto& hit) { return hit.has_value(); }));
}

}  // namespace beambench::verify
