#include "harness/thesis/mirrors.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "accel/beam/mirror_beams.hpp"
#include "accel/core/tolerance.hpp"
#include "harness/base/stopwatch.hpp"
#include "harness/measure/record/robust_statistics.hpp"
#include "harness/render/shading.hpp"
#include "scenes/planar_mirrors.hpp"

namespace beambench::thesis {
namespace {

using glm::dvec3;

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

/// Traces the rays of a batch twice: without its marks and with them.
MirrorResult compare(const accel::beam::BeamTracer& tracer, const accel::RayBatch& marked,
                     const scenes::PlanarSurface& plane, int repetitions) {
  accel::HitBuffer by_rays(static_cast<int>(marked.rays.size()), 1, 1);
  accel::HitBuffer by_beams = by_rays;
  MirrorResult result{plane.polygons.size(), marked.rays.size()};
  result.rays_ms = median_ms(
      repetitions, [&] { tracer.closest_hits(accel::RayBatch{marked.rays}, by_rays, {}); });
  result.beams_ms = median_ms(repetitions, [&] { tracer.closest_hits(marked, by_beams, {}); });
  for (std::size_t i = 0; i < marked.rays.size(); ++i) {
    result.hits += by_rays.get(i).has_value() ? 1 : 0;
    result.different += by_rays.get(i) == by_beams.get(i) ? 0 : 1;
  }
  return result;
}

/// The rays that one plane of glass transmits.
struct GlassView {
  std::vector<accel::Ray> rays;
  std::vector<std::uint32_t> samples;
  std::vector<double> angles;  ///< of incidence, in degrees
};

GlassView view_through(const scenes::PlanarSurface& glass, const scenes::Scene& scene,
                       const accel::PrimaryRays& image, const accel::HitBuffer& hits) {
  const scenes::Surface& surface = scene.surfaces[scene.primitives[glass.polygons.front()].surface];
  const double ratio = 1.0 / std::max(double{surface.refraction_index}, 1e-3);
  GlassView view;
  image.for_each(0, image.height(), [&](std::size_t index, const accel::Ray& ray) {
    const auto hit = hits.get(index);
    if (!hit || !std::ranges::binary_search(glass.polygons, hit->primitive)) return;
    const dvec3 incoming = glm::normalize(dvec3(ray.direction));
    const double side = glm::dot(incoming, glass.normal) < 0.0 ? 1.0 : -1.0;
    const dvec3 normal = side * glass.normal;
    const auto direction = render::refracted(incoming, normal, ratio);
    if (!direction) return;
    const dvec3 point = dvec3(ray.origin) + double{hit->t} * dvec3(ray.direction);
    accel::Ray& behind = view.rays.emplace_back();
    behind.origin = glm::vec3(point - accel::surface_lift(dvec3(ray.origin), point) * normal);
    behind.direction = glm::vec3(*direction);
    view.samples.push_back(static_cast<std::uint32_t>(index));
    view.angles.push_back(glm::degrees(std::acos(std::min(-glm::dot(incoming, normal), 1.0))));
  });
  return view;
}

std::optional<GlassResult> compare_glass(const accel::beam::BeamTracer& tracer,
                                         const scenes::Scene& scene,
                                         const scenes::PlanarSurface& glass,
                                         const accel::PrimaryRays& image,
                                         const accel::HitBuffer& hits, int repetitions) {
  const GlassView view = view_through(glass, scene, image, hits);
  if (view.rays.empty()) return std::nullopt;
  const accel::BatchMarks marks{{}, {{0, view.rays.size()}}};
  const accel::RayBatch batch{view.rays, {}, view.samples, &image, &marks};
  GlassResult result{compare(tracer, batch, glass, repetitions)};
  const std::vector<std::uint8_t> alone = tracer.traced_alone(batch);
  for (std::size_t i = 0; i < alone.size(); ++i) {
    const auto above =
        std::ranges::find_if(kIncidence, [&](int end) { return view.angles[i] < end; });
    GlassResult::Class& at = result.by_angle[std::min<std::size_t>(
        static_cast<std::size_t>(above - kIncidence.begin()), kIncidence.size() - 1)];
    ++at.samples;
    at.alone += alone[i];
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

GlassResult& GlassResult::operator+=(const GlassResult& other) {
  MirrorResult::operator+=(other);
  for (std::size_t i = 0; i < by_angle.size(); ++i) {
    by_angle[i].samples += other.by_angle[i].samples;
    by_angle[i].alone += other.by_angle[i].alone;
  }
  return *this;
}

MirrorComparison compare_mirrors(const accel::beam::BeamTracer& tracer, const scenes::Scene& scene,
                                 const accel::PrimaryRays& rays, const accel::HitBuffer& hits,
                                 int repetitions) {
  const std::vector<scenes::PlanarSurface> mirrors = scenes::planar_mirrors(scene);
  const std::vector<scenes::PlanarSurface> glasses = scenes::planar_glass(scene);
  MirrorComparison comparison{mirrors.size(), glasses.size(), {}, {}};
  for (const scenes::PlanarSurface& mirror : mirrors) {
    const auto view = accel::beam::view_in(mirror, rays, hits);
    if (!view) continue;
    const accel::Pencil pencil = view->pencil();
    comparison.seen.push_back(
        compare(tracer, {view->rays, {&pencil, 1}, view->samples}, mirror, repetitions));
  }
  for (const scenes::PlanarSurface& glass : glasses) {
    const auto result = compare_glass(tracer, scene, glass, rays, hits, repetitions);
    if (result) comparison.seen_through.push_back(*result);
  }
  return comparison;
}

}  // namespace beambench::thesis
