#include "harness/sweep/picture_task.hpp"

#include <limits>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "harness/rays/answers.hpp"
#include "harness/rays/fingerprint.hpp"
#include "harness/shade/judged_picture.hpp"
#include "harness/shade/whitted_picture.hpp"
#include "harness/sweep/conditions.hpp"
#include "harness/sweep/harness_time.hpp"

namespace beambench {
namespace {

HitBuffer rounded(const ReferenceHits& reference, const PrimaryRays& rays) {
  HitBuffer hits(rays.width(), rays.height(), rays.samples());
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const std::optional<ExactHit>& hit = reference.hits()[i];
    if (hit) hits.set(i, Hit{static_cast<float>(hit->t), hit->primitive});
  }
  return hits;
}

/// As the literature counts: a shadow ray is a point and a light.
std::uint64_t all_rays(const RayCensus& census) {
  return census.eye + census.reflected + census.refracted + census.shadow;
}

/// Of everything that is asked, eye rays first.
std::uint64_t hash_of(const PrimaryRays& eye, const RecordedPicture& picture) {
  std::string hashes = hex_digits(fingerprint(eye));
  for (const AskedRays& asked : picture.asked) {
    hashes += hex_digits(fingerprint(asked.closest)) + hex_digits(fingerprint(asked.any));
  }
  return fingerprint(hashes);
}

std::uint64_t hash_of(const Image& image) {
  const std::span<const glm::vec3> pixels = image.pixels();
  return fingerprint(
      std::string_view(reinterpret_cast<const char*>(pixels.data()),  // NOLINT: bytes
                       pixels.size_bytes()));
}

double share(std::uint64_t part, std::uint64_t whole) {
  return static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

PictureTask::PictureTask(const CellGroup& group, std::uint64_t scene_hash, int core)
    : Task(group),
      rays_(group.camera, group.resolution.width, group.resolution.height, group.samples),
      options_(whitted_options(group.rays)),
      eye_reference_(*group.scene, rays_),
      eye_(rays_.width(), rays_.height(), rays_.samples()),
      image_(rays_.width(), rays_.height()) {
  learn_facts(scene_hash, core);
}

/// Of the picture that the oracle's hits give. Its answers, known beforehand, also tell what the
/// picture takes without a structure.
void PictureTask::learn_facts(std::uint64_t scene_hash, int core) {
  const EmbreeOracle oracle(scene(), glm::length(glm::dvec3(rays_.eye())));
  const RecordedPicture picture =
      record_picture(scene(), OracleQueries(oracle), rays_, rounded(eye_reference_, rays_),
                     options_, HitCheck(scene(), "the oracle"));
  const RayCensus& census = picture.census;
  facts_.scene_hash = scene_hash;
  facts_.rays_hash = hash_of(rays_, picture);
  facts_.primitives = scene().primitives.size();
  facts_.rays = all_rays(census);
  facts_.query = Query::kPicture;
  facts_.hit_share = share(census.eye_hits + census.secondary_hits,
                           census.eye + census.reflected + census.refracted);
  if (census.shadow > 0) facts_.occluded_share = share(census.shadow_hidden, census.shadow);
  eye_ = picture.eye;
  const auto& [reflected, refracted, shadow] = picture.asked;
  shading_ms_ = harness_ms(core, [&] {
    const ReplayedAnswers mirrors(reflected);
    const ReplayedAnswers glass(refracted);
    const ReplayedAnswers lights(shadow);
    draw({&mirrors, &glass, &lights});
  });
}

RayCensus PictureTask::draw(const Answerers& answerers) {
  return draw_in_order(Whitted(scene(), answerers, options_, HitCheck(scene())), eye_rays(rays_),
                       eye_, image_);
}

void PictureTask::poison() {
  beambench::poison(eye_);
  constexpr float kNoLight = std::numeric_limits<float>::quiet_NaN();
  image_ = Image(image_.width(), image_.height(), glm::vec3(kNoLight));
}

void PictureTask::ask(const Accelerator& structure) {
  structure.trace(rays_, eye_);
  draw({&structure, &structure, &structure});
}

CountedWork PictureTask::count(const Accelerator& structure) {
  WorkCounters eye;
  ByFollowingRays<WorkCounters> following;
  structure.trace(rays_, eye_, eye);
  const CountedQueries reflected(structure, following[0]);
  const CountedQueries refracted(structure, following[1]);
  const CountedQueries shadow(structure, following[2]);
  const RayCensus census = draw({&reflected, &refracted, &shadow});

  CountedWork work;
  const ByFollowingRays<std::uint64_t> rays{census.reflected, census.refracted, census.shadow};
  work.kinds.push_back({"eye", census.eye, eye.by_name()});
  for (std::size_t i = 0; i < kFollowingRays; ++i) {
    work.kinds.push_back({std::string(kFollowingRayNames[i]), rays[i], following[i].by_name()});
    eye.add(following[i]);
  }
  work.counters = eye.by_name();
  return work;
}

std::uint64_t PictureTask::fingerprint() const {
  return beambench::fingerprint(hex_digits(beambench::fingerprint(eye_)) +
                                hex_digits(hash_of(image_)));
}

Judgement PictureTask::judge(const Accelerator& structure, const StructureChoice& choice) {
  poison();
  RecordedPicture picture = [&] {
    const MeasuringFloatMode mode;  // as it was timed
    structure.trace(rays_, eye_);
    return record_picture(scene(), structure, rays_, eye_, options_, HitCheck(scene(), choice));
  }();
  image_ = picture.image;
  const std::vector<JudgedRays> judged =
      judge_picture(eye_reference_, std::move(picture), choice.info().conformance);
  Judgement judgement{sum_of(judged), {}};
  for (const JudgedRays& rays : judged) {
    if (is_right(rays.report.verdict)) continue;
    for (const Mismatch& example : rays.report.examples) {
      judgement.examples.push_back(
          fmt::format("{} rays, {}", rays.kind, describe(scene(), rays.question, example)));
    }
  }
  return judgement;
}

}  // namespace beambench
