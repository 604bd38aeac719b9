#include "harness/thesis/mirrors.hpp"

#include "accel/beam/mirror_beams.hpp"
#include "harness/base/stopwatch.hpp"
#include "harness/measure/record/robust_statistics.hpp"

namespace beambench::thesis {
namespace {

template <class Work>
double median_ms(int repetitions, Work work) {
  std::vector<double> times;
  for (int i = 0; i < repetitions; ++i) {
    const base::Stopwatch stopwatch;
    work();
    times.push_back(stopwatch.milliseconds());
  }
  return measure::median(times);
}

MirrorResult compare(const accel::beam::BeamTracer& tracer, const accel::beam::MirrorView& view,
                     const scenes::PlanarMirror& mirror, int repetitions) {
  accel::HitBuffer by_rays(static_cast<int>(view.rays.size()), 1, 1);
  accel::HitBuffer by_beams = by_rays;
  MirrorResult result{mirror.polygons.size(), view.rays.size()};
  const accel::Pencil pencil = view.pencil();
  result.rays_ms =
      median_ms(repetitions, [&] { tracer.closest_hits(accel::RayBatch{view.rays}, by_rays, {}); });
  result.beams_ms = median_ms(repetitions, [&] {
    tracer.closest_hits(accel::RayBatch{view.rays, {&pencil, 1}, view.samples}, by_beams, {});
  });
  for (std::size_t i = 0; i < view.rays.size(); ++i) {
    result.hits += by_rays.get(i).has_value() ? 1 : 0;
    result.different += by_rays.get(i) == by_beams.get(i) ? 0 : 1;
  }
  return result;
}

}  // namespace

MirrorResult& MirrorResult::operator+=(const MirrorResult& other) {
  polygons += other.polygons;
  samples += other.samples;
  hits += other.hits;
  different += other.different;
  rays_ms += other.rays_ms;
  beams_ms += other.beams_ms;
  return *this;
}

MirrorComparison compare_mirrors(const accel::beam::BeamTracer& tracer, const scenes::Scene& scene,
                                 const accel::PrimaryRays& rays, const accel::HitBuffer& hits,
                                 int repetitions) {
  const std::vector<scenes::PlanarMirror> mirrors = scenes::planar_mirrors(scene);
  MirrorComparison comparison{mirrors.size(), {}};
  for (const scenes::PlanarMirror& mirror : mirrors) {
    const auto view = accel::beam::view_in(mirror, rays, hits);
    if (view) comparison.seen.push_back(compare(tracer, *view, mirror, repetitions));
  }
  return comparison;
}

}  // namespace beambench::thesis
