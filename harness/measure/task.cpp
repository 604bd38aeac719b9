#include "harness/measure/task.hpp"

#include <limits>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "accel/core/hit_buffer.hpp"
#include "harness/measure/measurement.hpp"
#include "harness/plugin/load_plugin.hpp"
#include "harness/rays/counted_queries.hpp"
#include "harness/rays/fingerprint.hpp"
#include "harness/rays/trace_results.hpp"
#include "harness/render/picture/image.hpp"
#include "harness/render/verified_picture.hpp"
#include "harness/render/whitted.hpp"
#include "harness/render/whitted_picture.hpp"
#include "harness/verify/describe.hpp"

namespace beambench::measure {
namespace {

double share(std::uint64_t part, std::uint64_t whole) {
  return static_cast<double>(part) / static_cast<double>(whole);
}

/// Throws InputError if the rays are not those that an earlier process traced.
void require_same(std::uint64_t hash, std::uint64_t known) {
  if (hash == known) return;
  throw InputError(fmt::format("the rays have changed during the run (hashes {} and {})",
                               rays::hex_digits(known), rays::hex_digits(hash)));
}

/// Rays that do not depend on the results: the rays of an image, or a list of rays.
class RaysTask : public Task {
 public:
  RaysTask(const CellGroup& group, const rays::RayChoice& rays, int core,
           const std::optional<RaySetFacts>& known)
      : Task(group, known),
        input_(rays::make_trace_input(*group.scene, group.image(), rays)),
        results_(rays::make_results(input())),
        core_(core) {
    if (known) require_same(rays::fingerprint(input()), known->rays_hash);
  }

  std::optional<std::string> warning() override {
    return rays::share_warning(input(), reference().hit_count());
  }
  void poison() override { rays::poison(results_); }
  void require_support(const accel::StructureChoice& choice) const override {
    rays::require_support(choice, input());
  }
  void trace(const accel::Accelerator& structure) override {
    rays::trace(structure, input(), results_, nullptr, group_.threads);
  }
  CountedWork count(const accel::Accelerator& structure) override {
    accel::WorkCounters counters;
    rays::trace(structure, input(), results_, &counters);
    return {counters.by_name(), {}};
  }
  std::uint64_t fingerprint() const override { return rays::fingerprint(results_); }

  Verification verify_results(const accel::Accelerator&,
                              const accel::StructureChoice& choice) override {
    Verification found{verify::verify_results(reference(), results_, choice.info().conformance),
                       {}};
    if (verify::is_right(found.report.verdict)) return found;
    const verify::ReplayCommand replay(plugin::program_call(), scene(), group_.image(), choice,
                                       input());
    for (const verify::Mismatch& example : found.report.examples) {
      found.examples.push_back(verify::describe(scene(), input(), example, replay));
    }
    return found;
  }

 private:
  RaySetFacts find_facts() override {
    RaySetFacts facts;
    facts.scene_hash = group_.scene_hash;
    facts.rays_hash = rays::fingerprint(input());
    facts.seed = input().seed();
    facts.primitives = scene().primitives.size();
    facts.rays = input().size();
    facts.query = input().query();
    const bool any_hit = facts.query == rays::Query::kAnyHit;
    (any_hit ? facts.occluded_share : facts.hit_share) =
        share(reference().hit_count(), input().size());
    facts.coherence = rays::coherence(input());
    return facts;
  }
  std::uint64_t ray_count() override { return input().size(); }
  bool has_lists() const override { return input().image() == nullptr; }
  QueryPath path_of(const accel::Accelerator& structure) const override {
    const accel::ImageRays made = structure.statistics().image_rays;
    if (input().image() == nullptr) {
      return made == accel::ImageRays::kSimd ? QueryPath::kListPacked : QueryPath::kList;
    }
    switch (made) {
      case accel::ImageRays::kSimd:
        return QueryPath::kImageSimd;
      case accel::ImageRays::kOwn:
        return QueryPath::kImageOwn;
      case accel::ImageRays::kSingle:
        break;
    }
    return QueryPath::kImageSingle;
  }
  double measure_harness_ms(QueryPath path) override {
    const bool is_simd = path == QueryPath::kImageSimd || path == QueryPath::kListPacked;
    const char* const rays = is_simd ? "simd" : "single";
    const auto null = accel::registry().choose({"null", {{"rays", rays}}}).build(scene());
    return harness_ms(core_, [&] { trace(*null); });
  }
  /// Returns the oracle's hits, found when first needed.
  const verify::ReferenceHits& reference() {
    if (!reference_) reference_.emplace(scene(), *std::exchange(input_, std::nullopt));
    return *reference_;
  }
  const rays::TraceInput& input() const { return input_ ? *input_ : reference_->input(); }

  std::optional<rays::TraceInput> input_;  ///< empty once the reference has it
  std::optional<verify::ReferenceHits> reference_;
  rays::TraceResults results_;
  int core_;
};

/// Returns the hash of all rays, camera rays first.
std::uint64_t hash_of(const accel::PrimaryRays& rays, const render::RecordedPicture& picture) {
  std::string hashes = rays::hex_digits(rays::fingerprint(rays));
  for (const render::AskedRays& asked : picture.asked) {
    hashes += rays::hex_digits(rays::fingerprint(asked.closest)) +
              rays::hex_digits(rays::fingerprint(asked.any));
  }
  return rays::fingerprint(hashes);
}

/// The picture of `render --shade whitted`, on one thread: camera rays by the structure's traversal
/// for images (beams), the rest in waves, shading included. Verification covers every hit that the
/// picture depends on, including those of reflected, refracted and shadow rays, rather than the
/// picture itself: a second rendering, with all these rays recorded, must equal the timed one bit
/// for bit.
class PictureTask : public Task {
 public:
  PictureTask(const CellGroup& group, const rays::RayChoice& rays, int core,
              const std::optional<RaySetFacts>& known)
      : Task(group, known),
        core_(core),
        rays_(group.image().rays()),
        options_(render::whitted_options(rays)),
        shaded_(std::make_shared<const render::ShadedScene>(*group.scene)),
        hits_(rays_.width(), rays_.height(), rays_.samples()),
        image_(rays_.width(), rays_.height()) {}

  void poison() override {
    rays::poison(hits_);
    constexpr float kNoLight = std::numeric_limits<float>::quiet_NaN();
    image_ = render::Image(image_.width(), image_.height(), glm::vec3(kNoLight));
  }
  void require_support(const accel::StructureChoice& choice) const override {
    render::require_support(choice);
  }
  void trace(const accel::Accelerator& structure) override {
    structure.closest_hits(rays_, hits_, {});
    draw({&structure, &structure, &structure});
  }
  CountedWork count(const accel::Accelerator& structure) override {
    accel::WorkCounters all;
    structure.closest_hits(rays_, hits_, {&all});
    const rays::CountedQueries reflected(structure);
    const rays::CountedQueries refracted(structure);
    const rays::CountedQueries shadow(structure);
    const render::RayCensus census = draw({&reflected, &refracted, &shadow});
    const render::ByFollowingRays<accel::WorkCounters> following{
        reflected.work().counters, refracted.work().counters, shadow.work().counters};

    CountedWork work;
    const render::ByFollowingRays<std::uint64_t> rays{census.reflected, census.refracted,
                                                      census.shadow};
    work.kinds.push_back({"camera", census.eye, all.by_name()});
    for (std::size_t i = 0; i < render::kFollowingRays; ++i) {
      work.kinds.push_back(
          {std::string(render::kFollowingRayNames[i]), rays[i], following[i].by_name()});
      all.add(following[i]);
    }
    work.counters = all.by_name();
    return work;
  }
  std::uint64_t fingerprint() const override {
    return rays::fingerprint(rays::hex_digits(rays::fingerprint(hits_)) +
                             rays::hex_digits(render::fingerprint(image_)));
  }

  Verification verify_results(const accel::Accelerator& structure,
                              const accel::StructureChoice& choice) override {
    poison();
    render::RecordedPicture picture = [&] {
      const MeasuringFloatMode mode;  // the mode in which it was timed
      structure.closest_hits(rays_, hits_, {});
      return render::record_picture(shaded_, structure, rays_, hits_, options_,
                                    rays::HitCheck(scene(), choice));
    }();
    image_ = picture.image;
    const std::vector<render::VerifiedRays> verified =
        render::verify_recorded_picture(reference(), std::move(picture), choice.info().conformance);
    return {render::sum_of(verified), render::described_examples(scene(), verified)};
  }

 private:
  QueryPath path_of(const accel::Accelerator&) const override { return QueryPath::kPicture; }
  double measure_harness_ms(QueryPath) override {
    if (!shading_ms_) find_facts();
    return *shading_ms_;
  }

  /// Returns the oracle's hits, found when first needed.
  const verify::ReferenceHits& reference() {
    if (!reference_) reference_.emplace(scene(), rays_);
    return *reference_;
  }

  std::uint64_t ray_count() override { return facts().rays; }
  bool has_lists() const override { return true; }

  /// Determines the facts, and the time of drawing the picture from known hits, without a
  /// structure.
  RaySetFacts find_facts() override {
    const accel::oracle::Oracle oracle(scene(), glm::length(glm::dvec3(rays_.eye())));
    const render::RecordedPicture picture =
        render::record_picture(shaded_, render::OracleQueries(oracle), rays_, reference().rounded(),
                               options_, rays::HitCheck(scene(), "the oracle"));
    hits_ = picture.primary;
    const auto& [reflected, refracted, shadow] = picture.asked;
    shading_ms_ = harness_ms(core_, [&] {
      const render::ReplayedResults mirrors(reflected);
      const render::ReplayedResults glass(refracted);
      const render::ReplayedResults lights(shadow);
      draw({&mirrors, &glass, &lights});
    });
    return facts_of(picture);
  }

  RaySetFacts facts_of(const render::RecordedPicture& picture) const {
    const render::RayCensus& census = picture.census;
    RaySetFacts facts;
    facts.scene_hash = group_.scene_hash;
    facts.rays_hash = hash_of(rays_, picture);
    facts.primitives = scene().primitives.size();
    facts.rays = census.all_rays();
    facts.query = rays::Query::kPicture;
    facts.hit_share = share(census.eye_hits + census.secondary_hits,
                            census.eye + census.reflected + census.refracted);
    if (census.shadow > 0) facts.occluded_share = share(census.shadow_hidden, census.shadow);
    return facts;
  }
  render::RayCensus draw(const render::RayStructures& structures) {
    return render::draw_in_order(
        render::Whitted(shaded_, structures, options_, rays::HitCheck(scene())), rays_, hits_,
        image_);
  }

  int core_;
  accel::PrimaryRays rays_;
  render::WhittedOptions options_;
  std::shared_ptr<const render::ShadedScene> shaded_;
  std::optional<verify::ReferenceHits> reference_;
  accel::HitBuffer hits_;
  render::Image image_;
  std::optional<double> shading_ms_;
};

}  // namespace

HarnessShare Task::harness_share(const accel::Accelerator& structure) {
  const QueryPath path = path_of(structure);
  if (path == QueryPath::kImageOwn) return {path, 0.0};
  const auto [entry, is_new] = harness_ms_.try_emplace(path);
  if (is_new) entry->second = measure_harness_ms(path);
  return {path, entry->second};
}

std::unique_ptr<Task> make_task(const CellGroup& group, const rays::RayChoice& rays, int core,
                                const std::optional<RaySetFacts>& known) {
  if (rays.kind == rays::RayKind::kWhitted) {
    return std::make_unique<PictureTask>(group, rays, core, known);
  }
  return std::make_unique<RaysTask>(group, rays, core, known);
}

}  // namespace beambench::measure
