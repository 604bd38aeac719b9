#include "harness/thesis/census.hpp"

#include <memory>
#include <utility>

#include <fmt/format.h>

#include "harness/base/stopwatch.hpp"
#include "harness/rays/hit_check.hpp"
#include "harness/rays/trace_results.hpp"
#include "harness/render/picture/image.hpp"
#include "harness/render/shaded_scene.hpp"
#include "harness/render/whitted.hpp"
#include "harness/render/whitted_picture.hpp"
#include "harness/thesis/counted_queries.hpp"

namespace beambench::thesis {
namespace {

/// Returns the hits of primary rays: from one query for the image or, for rays through the corners
/// of pixels, from single rays.
accel::HitBuffer primary_hits(const accel::Accelerator& structure, const accel::PrimaryRays& rays,
                              const accel::PrimaryRays* image) {
  accel::HitBuffer hits(rays.width(), rays.height(), rays.samples());
  if (image != nullptr) {
    structure.closest_hits(*image, hits, {});
    return hits;
  }
  for (int y = 0; y < rays.height(); ++y) {
    for (int x = 0; x < rays.width(); ++x) {
      hits.set(hits.index(x, y, 0), structure.closest_hit(rays.ray(x, y, 0), nullptr));
    }
  }
  return hits;
}

/// The settings shared by all pictures of a census.
struct Setting {
  const scenes::Scene& scene;
  const accel::Accelerator& structure;
  const rays::HitCheck& check;
  const accel::PrimaryRays& primary;
  const accel::PrimaryRays& rays;
  const accel::HitBuffer& hits;
  const CensusOptions& options;
  base::Progress& progress;
};

render::WhittedOptions whitted_options(const CensusOptions& options) {
  render::WhittedOptions whitted = options.whitted;
  whitted.glass_always_mirrors = options.spd_rules;
  return whitted;
}

render::WhittedPicture draw(const Setting& at, const render::Whitted& tracer,
                            render::ShadingOrder order) {
  const auto watch = [&](double part) { at.progress.advance(part); };
  if (order == render::ShadingOrder::kRows) {
    return render::whitted_picture(tracer, at.rays, at.hits, watch, at.options.threads);
  }
  const auto places = order == render::ShadingOrder::kBeams
                          ? render::beam_order(at.structure, at.primary)
                          : render::scan_order(at.primary);
  return render::whitted_picture_along(places, tracer, at.rays, at.hits, watch);
}

FullPicture draw_full(const Setting& at, const render::Image& picture) {
  render::WhittedOptions whitted = whitted_options(at.options);
  whitted.min_weight = 0.0;
  at.progress.start(fmt::format("{} without --min-weight", at.scene.name));
  const render::Whitted tracer(at.scene, at.structure, whitted, at.check);
  const base::Stopwatch stopwatch;
  const render::WhittedPicture full = draw(at, tracer, render::ShadingOrder::kRows);
  const double picture_ms = stopwatch.milliseconds();
  at.progress.finish(fmt::format("{} rays", full.census.all_rays()));
  return {full.census.all_rays(), picture_ms, render::root_mean_square_error(picture, full.image)};
}

}  // namespace

CensusResult take_census(const accel::StructureChoice& choice, const scenes::Scene& scene,
                         const rays::ImageOfRays& image, const CensusOptions& options,
                         base::Progress& progress) {
  const accel::PrimaryRays primary = image.rays();
  progress.start(fmt::format("{} over {}", choice.info().name, scene.name));
  CensusResult result{scene.name, scene.lights.size(), {}, 0, 0, 0, 0, 0, {},
                      {},         render::Image(1, 1)};
  const base::Stopwatch all;
  base::Stopwatch stopwatch;
  const auto built = choice.build(scene, rays::workload_of(image, primary));
  result.build_ms = stopwatch.milliseconds();
  const CountedQueries paths(*built);
  const CountedShadows shadows(*built);
  const accel::Accelerator& structure =
      options.count_work ? static_cast<const accel::Accelerator&>(paths) : *built;
  const accel::Accelerator& of_shadows =
      options.count_work ? static_cast<const accel::Accelerator&>(shadows) : *built;
  const accel::PrimaryRays rays = options.spd_rules ? render::corner_rays(image.camera) : primary;
  stopwatch = {};
  const accel::HitBuffer hits =
      primary_hits(structure, rays, options.spd_rules ? nullptr : &primary);
  result.eye_ms = stopwatch.milliseconds();
  const rays::HitCheck check(scene, choice);
  check.require(hits, rays);
  const Setting setting{scene, structure, check, primary, rays, hits, options, progress};
  stopwatch = {};
  const render::Whitted tracer(std::make_shared<const render::ShadedScene>(scene),
                               {&structure, &structure, &of_shadows}, whitted_options(options),
                               check);
  result.preparation_ms = stopwatch.milliseconds();
  stopwatch = {};
  render::WhittedPicture picture = draw(setting, tracer, options.order);
  result.picture_ms = stopwatch.milliseconds();
  result.census = picture.census;
  result.shadow_bytes = tracer.shadows().memory_bytes();
  result.picture = std::move(picture.image);
  if (options.count_work) {
    QueryWork queries = paths.work();
    queries.add(shadows.work());
    result.work = {built->statistics(), std::move(queries)};
  }
  progress.finish(
      fmt::format("{} rays in {}", result.census.all_rays(), base::format_duration(all.seconds())));
  if (options.whitted.min_weight > 0.0) result.full = draw_full(setting, result.picture);
  return result;
}

}  // namespace beambench::thesis
