#include "harness/bench/task.hpp"

#include <limits>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "accel/core/hit_buffer.hpp"
#include "harness/bench/measurement.hpp"
#include "harness/rays/fingerprint.hpp"
#include "harness/rays/trace_results.hpp"
#include "harness/render/picture/image.hpp"
#include "harness/render/verified_picture.hpp"
#include "harness/render/whitted.hpp"
#include "harness/render/whitted_picture.hpp"
#include "harness/verify/describe.hpp"

namespace beambench::bench {
namespace {

/// Rays that are the same whatever is answered: an image's, or a list.
class RaysTask : public Task {
 public:
  RaysTask(const CellGroup& group, std::uint64_t scene_hash, int core);

  std::optional<std::string> warning() const override;
  void poison() override { beambench::rays::poison(results_); }
  void ask(const accel::Accelerator& structure) override;
  CountedWork count(const accel::Accelerator& structure) override;
  std::uint64_t fingerprint() const override;
  Judgment judge(const accel::Accelerator& structure,
                 const accel::StructureChoice& choice) override;

 private:
  QueryPath path_of(const accel::Accelerator& structure) const override;
  double measure_harness_ms(QueryPath path) override;

  const rays::TraceInput& input() const { return reference_.input(); }

  verify::ReferenceHits reference_;
  rays::TraceResults results_;
  int core_;
};

RaySetFacts facts_of(const verify::ReferenceHits& reference, std::uint64_t scene_hash) {
  const rays::TraceInput& input = reference.input();
  const auto rays = static_cast<double>(input.size());
  const double share = static_cast<double>(reference.hit_count()) / rays;
  RaySetFacts facts;
  facts.scene_hash = scene_hash;
  facts.rays_hash = rays::fingerprint(input);
  facts.seed = input.seed();
  facts.primitives = reference.scene().primitives.size();
  facts.rays = input.size();
  facts.query = input.query();
  (input.query() == rays::Query::kAnyHit ? facts.occluded_share : facts.hit_share) = share;
  facts.coherence = rays::coherence(input);
  return facts;
}

RaysTask::RaysTask(const CellGroup& group, std::uint64_t scene_hash, int core)
    : Task(group),
      reference_(*group.scene, rays::make_trace_input(*group.scene, group.image(), group.rays)),
      results_(rays::make_results(input())),
      core_(core) {
  facts_ = facts_of(reference_, scene_hash);
}

QueryPath RaysTask::path_of(const accel::Accelerator& structure) const {
  if (input().image() == nullptr) return QueryPath::kList;
  return image_path(structure.statistics().image_rays);
}

double RaysTask::measure_harness_ms(QueryPath path) {
  const char* const rays = path == QueryPath::kImageSimd ? "simd" : "single";
  const auto null = accel::registry().choose({"null", {{"rays", rays}}}).build(scene());
  return harness_ms(core_, [&] { ask(*null); });
}

std::optional<std::string> RaysTask::warning() const {
  return rays::share_warning(input(), reference_.hit_count());
}

void RaysTask::ask(const accel::Accelerator& structure) {
  beambench::rays::trace(structure, input(), results_, nullptr, group_.threads);
}

CountedWork RaysTask::count(const accel::Accelerator& structure) {
  accel::WorkCounters counters;
  beambench::rays::trace(structure, input(), results_, &counters);
  return {counters.by_name(), {}};
}

std::uint64_t RaysTask::fingerprint() const { return beambench::rays::fingerprint(results_); }

Judgment RaysTask::judge(const accel::Accelerator&, const accel::StructureChoice& choice) {
  Judgment judgment{beambench::verify::judge(reference_, results_, choice.info().conformance), {}};
  if (verify::is_right(judgment.report.verdict)) return judgment;
  const verify::ReplayCommand replay(scene(), group_.image(), choice, input());
  for (const verify::Mismatch& example : judgment.report.examples) {
    judgment.examples.push_back(verify::describe(scene(), input(), example, replay));
  }
  return judgment;
}

/// The picture of `render --shade whitted`, on one thread: the eye's rays by what the structure has
/// for images (beams), the rest ray by ray, shading included. Judged is not the picture but every
/// answer that it rests on, reflected, refracted and shadow rays too: a second drawing, with all
/// of them written down, must give the same bits as the timed one.
class PictureTask : public Task {
 public:
  PictureTask(const CellGroup& group, std::uint64_t scene_hash, int core);

  void poison() override;
  void ask(const accel::Accelerator& structure) override;
  CountedWork count(const accel::Accelerator& structure) override;
  std::uint64_t fingerprint() const override;
  Judgment judge(const accel::Accelerator& structure,
                 const accel::StructureChoice& choice) override;

 private:
  QueryPath path_of(const accel::Accelerator&) const override { return QueryPath::kPicture; }
  double measure_harness_ms(QueryPath) override { return shading_ms_; }
  void learn_facts(std::uint64_t scene_hash, int core);
  render::RayCensus draw(const render::Answerers& answerers);

  accel::PrimaryRays rays_;
  render::WhittedOptions options_;
  verify::ReferenceHits eye_reference_;
  accel::HitBuffer eye_;
  render::Image image_;
  double shading_ms_ = 0.0;
};

accel::HitBuffer rounded(const verify::ReferenceHits& reference, const accel::PrimaryRays& rays) {
  accel::HitBuffer hits(rays.width(), rays.height(), rays.samples());
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const std::optional<accel::embree::ExactHit>& hit = reference.hits()[i];
    if (hit) hits.set(i, accel::Hit{static_cast<float>(hit->t), hit->primitive});
  }
  return hits;
}

/// As the literature counts: a shadow ray is a point and a light.
std::uint64_t all_rays(const render::RayCensus& census) {
  return census.eye + census.reflected + census.refracted + census.shadow;
}

/// Of everything that is asked, eye rays first.
std::uint64_t hash_of(const accel::PrimaryRays& eye, const render::RecordedPicture& picture) {
  std::string hashes = rays::hex_digits(rays::fingerprint(eye));
  for (const render::AskedRays& asked : picture.asked) {
    hashes += rays::hex_digits(rays::fingerprint(asked.closest)) +
              rays::hex_digits(rays::fingerprint(asked.any));
  }
  return rays::fingerprint(hashes);
}

std::uint64_t hash_of(const render::Image& image) {
  const std::span<const glm::vec3> pixels = image.pixels();
  return rays::fingerprint(
      std::string_view(reinterpret_cast<const char*>(pixels.data()),  // NOLINT: bytes
                       pixels.size_bytes()));
}

double share(std::uint64_t part, std::uint64_t whole) {
  return static_cast<double>(part) / static_cast<double>(whole);
}

PictureTask::PictureTask(const CellGroup& group, std::uint64_t scene_hash, int core)
    : Task(group),
      rays_(group.camera, group.resolution.width, group.resolution.height, group.samples),
      options_(render::whitted_options(group.rays)),
      eye_reference_(*group.scene, rays_),
      eye_(rays_.width(), rays_.height(), rays_.samples()),
      image_(rays_.width(), rays_.height()) {
  learn_facts(scene_hash, core);
}

/// Of the picture that the oracle's hits give. Its answers, known beforehand, also tell what the
/// picture takes without a structure.
void PictureTask::learn_facts(std::uint64_t scene_hash, int core) {
  const accel::embree::EmbreeOracle oracle(scene(), glm::length(glm::dvec3(rays_.eye())));
  const render::RecordedPicture picture = render::record_picture(
      scene(), render::OracleQueries(oracle), rays_, rounded(eye_reference_, rays_), options_,
      rays::HitCheck(scene(), "the oracle"));
  const render::RayCensus& census = picture.census;
  facts_.scene_hash = scene_hash;
  facts_.rays_hash = hash_of(rays_, picture);
  facts_.primitives = scene().primitives.size();
  facts_.rays = all_rays(census);
  facts_.query = rays::Query::kPicture;
  facts_.hit_share = share(census.eye_hits + census.secondary_hits,
                           census.eye + census.reflected + census.refracted);
  if (census.shadow > 0) facts_.occluded_share = share(census.shadow_hidden, census.shadow);
  eye_ = picture.eye;
  const auto& [reflected, refracted, shadow] = picture.asked;
  shading_ms_ = harness_ms(core, [&] {
    const render::ReplayedAnswers mirrors(reflected);
    const render::ReplayedAnswers glass(refracted);
    const render::ReplayedAnswers lights(shadow);
    draw({&mirrors, &glass, &lights});
  });
}

render::RayCensus PictureTask::draw(const render::Answerers& answerers) {
  return render::draw_in_order(
      render::Whitted(scene(), answerers, options_, rays::HitCheck(scene())),
      render::eye_rays(rays_), eye_, image_);
}

void PictureTask::poison() {
  beambench::rays::poison(eye_);
  constexpr float kNoLight = std::numeric_limits<float>::quiet_NaN();
  image_ = render::Image(image_.width(), image_.height(), glm::vec3(kNoLight));
}

void PictureTask::ask(const accel::Accelerator& structure) {
  structure.trace(rays_, eye_, nullptr);
  draw({&structure, &structure, &structure});
}

CountedWork PictureTask::count(const accel::Accelerator& structure) {
  accel::WorkCounters eye;
  render::ByFollowingRays<accel::WorkCounters> following;
  structure.trace(rays_, eye_, &eye);
  const render::CountedQueries reflected(structure, following[0]);
  const render::CountedQueries refracted(structure, following[1]);
  const render::CountedQueries shadow(structure, following[2]);
  const render::RayCensus census = draw({&reflected, &refracted, &shadow});

  CountedWork work;
  const render::ByFollowingRays<std::uint64_t> rays{census.reflected, census.refracted,
                                                    census.shadow};
  work.kinds.push_back({"eye", census.eye, eye.by_name()});
  for (std::size_t i = 0; i < render::kFollowingRays; ++i) {
    work.kinds.push_back(
        {std::string(render::kFollowingRayNames[i]), rays[i], following[i].by_name()});
    eye.add(following[i]);
  }
  work.counters = eye.by_name();
  return work;
}

std::uint64_t PictureTask::fingerprint() const {
  return beambench::rays::fingerprint(rays::hex_digits(beambench::rays::fingerprint(eye_)) +
                                      rays::hex_digits(hash_of(image_)));
}

Judgment PictureTask::judge(const accel::Accelerator& structure,
                            const accel::StructureChoice& choice) {
  poison();
  render::RecordedPicture picture = [&] {
    const MeasuringFloatMode mode;  // as it was timed
    structure.trace(rays_, eye_, nullptr);
    return render::record_picture(scene(), structure, rays_, eye_, options_,
                                  rays::HitCheck(scene(), choice));
  }();
  image_ = picture.image;
  const std::vector<render::JudgedRays> judged =
      render::judge_picture(eye_reference_, std::move(picture), choice.info().conformance);
  Judgment judgment{render::sum_of(judged), {}};
  for (const render::JudgedRays& rays : judged) {
    if (verify::is_right(rays.report.verdict)) continue;
    for (const verify::Mismatch& example : rays.report.examples) {
      judgment.examples.push_back(
          fmt::format("{} rays, {}", rays.kind, verify::describe(scene(), rays.input, example)));
    }
  }
  return judgment;
}

}  // namespace

HarnessShare Task::harness_share(const accel::Accelerator& structure) {
  const QueryPath path = path_of(structure);
  if (path == QueryPath::kImageOwn) return {path, 0.0};
  const auto [entry, is_new] = harness_ms_.try_emplace(path);
  if (is_new) entry->second = measure_harness_ms(path);
  return {path, entry->second};
}

std::unique_ptr<Task> make_task(const CellGroup& group, std::uint64_t scene_hash, int core) {
  if (group.rays.kind == rays::RayKind::kWhitted) {
    return std::make_unique<PictureTask>(group, scene_hash, core);
  }
  return std::make_unique<RaysTask>(group, scene_hash, core);
}

}  // namespace beambench::bench
