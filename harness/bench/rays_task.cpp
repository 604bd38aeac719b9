#include "harness/bench/rays_task.hpp"

#include "harness/bench/harness_time.hpp"
#include "harness/rays/fingerprint.hpp"
#include "harness/rays/share_warning.hpp"

namespace beambench::bench {
namespace {

RaySetFacts facts_of(const verify::ReferenceHits& reference, std::uint64_t scene_hash) {
  const rays::Question& question = reference.question();
  const auto rays = static_cast<double>(question.size());
  const double share = static_cast<double>(reference.hit_count()) / rays;
  RaySetFacts facts;
  facts.scene_hash = scene_hash;
  facts.rays_hash = rays::fingerprint(question);
  facts.seed = question.seed();
  facts.primitives = reference.scene().primitives.size();
  facts.rays = question.size();
  facts.query = question.query();
  (question.query() == rays::Query::kAnyHit ? facts.occluded_share : facts.hit_share) = share;
  facts.coherence = rays::coherence(question);
  return facts;
}

}  // namespace

RaysTask::RaysTask(const CellGroup& group, std::uint64_t scene_hash, int core)
    : Task(group),
      reference_(*group.scene, rays::make_question(*group.scene, group.image(), group.rays)),
      answers_(rays::room_for(question())),
      core_(core) {
  facts_ = facts_of(reference_, scene_hash);
}

QueryPath RaysTask::path_of(const accel::Accelerator& structure) const {
  if (question().image() == nullptr) return QueryPath::kList;
  return image_path(structure.statistics().image_rays);
}

double RaysTask::measure_harness_ms(QueryPath path) {
  const char* const rays = path == QueryPath::kImageSimd ? "simd" : "single";
  const auto null = accel::registry().choose({"null", {{"rays", rays}}}).build(scene());
  return harness_ms(core_, [&] { ask(*null); });
}

std::optional<std::string> RaysTask::warning() const {
  return rays::share_warning(question(), reference_.hit_count());
}

void RaysTask::ask(const accel::Accelerator& structure) {
  beambench::rays::ask(structure, question(), answers_, group_.threads);
}

CountedWork RaysTask::count(const accel::Accelerator& structure) {
  accel::WorkCounters counters;
  beambench::rays::ask(structure, question(), answers_, counters);
  return {counters.by_name(), {}};
}

std::uint64_t RaysTask::fingerprint() const { return beambench::rays::fingerprint(answers_); }

Judgment RaysTask::judge(const accel::Accelerator&, const accel::StructureChoice& choice) {
  Judgment judgment{beambench::verify::judge(reference_, answers_, choice.info().conformance), {}};
  if (verify::is_right(judgment.report.verdict)) return judgment;
  const verify::ReplayCommand replay(scene(), group_.image(), choice, question());
  for (const verify::Mismatch& example : judgment.report.examples) {
    judgment.examples.push_back(verify::describe(scene(), question(), example, replay));
  }
  return judgment;
}

}  // namespace beambench::bench
