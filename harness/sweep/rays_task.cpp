#include "harness/sweep/rays_task.hpp"

#include "harness/rays/fingerprint.hpp"
#include "harness/rays/share_warning.hpp"
#include "harness/sweep/harness_time.hpp"

namespace beambench {
namespace {

RaySetFacts facts_of(const ReferenceHits& reference, std::uint64_t scene_hash) {
  const Question& question = reference.question();
  const auto rays = static_cast<double>(question.size());
  const double share = static_cast<double>(reference.hit_count()) / rays;
  RaySetFacts facts;
  facts.scene_hash = scene_hash;
  facts.rays_hash = fingerprint(question);
  facts.seed = question.seed();
  facts.primitives = reference.scene().primitives.size();
  facts.rays = question.size();
  facts.query = question.query();
  (question.query() == Query::kAnyHit ? facts.occluded_share : facts.hit_share) = share;
  facts.coherence = coherence(question);
  return facts;
}

}  // namespace

RaysTask::RaysTask(const CellGroup& group, std::uint64_t scene_hash, int core)
    : Task(group),
      reference_(*group.scene, make_question(*group.scene, group.image(), group.rays)),
      answers_(room_for(question())),
      core_(core) {
  facts_ = facts_of(reference_, scene_hash);
}

QueryPath RaysTask::path_of(const Accelerator& structure) const {
  if (question().image() == nullptr) return QueryPath::kList;
  return image_path(structure.statistics().image_rays);
}

double RaysTask::measure_harness_ms(QueryPath path) {
  const char* const rays = path == QueryPath::kImageSimd ? "simd" : "single";
  const auto null = registry().choose({"null", {{"rays", rays}}}).build(scene());
  return harness_ms(core_, [&] { ask(*null); });
}

std::optional<std::string> RaysTask::warning() const {
  return share_warning(question(), reference_.hit_count());
}

void RaysTask::ask(const Accelerator& structure) {
  beambench::ask(structure, question(), answers_, group_.threads);
}

CountedWork RaysTask::count(const Accelerator& structure) {
  WorkCounters counters;
  beambench::ask(structure, question(), answers_, counters);
  return {counters.by_name(), {}};
}

std::uint64_t RaysTask::fingerprint() const { return beambench::fingerprint(answers_); }

Judgement RaysTask::judge(const Accelerator&, const StructureChoice& choice) {
  Judgement judgement{beambench::judge(reference_, answers_, choice.info().conformance), {}};
  if (is_right(judgement.report.verdict)) return judgement;
  const ReplayCommand replay(scene(), group_.image(), choice, question());
  for (const Mismatch& example : judgement.report.examples) {
    judgement.examples.push_back(describe(scene(), question(), example, replay));
  }
  return judgement;
}

}  // namespace beambench
