#include "harness/rays/ray_generators.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include "accel/core/tolerance.hpp"
#include "accel/oracle/oracle.hpp"
#include "harness/rays/normal.hpp"
#include "harness/rays/picture_order.hpp"
#include "harness/rays/trace_input.hpp"
#include "scenes/base/portable_math.hpp"
#include "scenes/base/random.hpp"

namespace beambench::rays {
namespace {

using glm::dvec3;

SurfacePoint point_of(const scenes::Scene& scene, const MirrorTable& mirrors, const accel::Ray& ray,
                      const accel::oracle::ExactHit& hit, std::size_t sample) {
  const dvec3 origin(ray.origin);
  const dvec3 direction(ray.direction);
  const dvec3 point = origin + hit.t * direction;
  return {point,
          geometric_normal(scene, ray, {static_cast<float>(hit.t), hit.primitive}),
          glm::normalize(direction),
          mirrors.lift_at(hit.primitive, origin, point),
          hit.primitive,
          static_cast<std::uint32_t>(sample)};
}

accel::Ray& add_ray(const SurfacePoint& at, const dvec3& direction, RayList& list) {
  accel::Ray& ray = list.rays.emplace_back();
  ray.origin = glm::vec3(at.beside());
  ray.direction = glm::vec3(direction);
  list.samples.push_back(at.sample);
  return ray;
}

void reserve(std::size_t rays, RayList& list) {
  list.rays.reserve(rays);
  list.samples.reserve(rays);
}

/// Returns the surface points at the hits of the list's rays, starting at ray `first`.
std::vector<SurfacePoint> points_hit(const scenes::Scene& scene, const MirrorTable& mirrors,
                                     const accel::oracle::Oracle& oracle, const RayList& list,
                                     std::size_t first) {
  std::vector<std::optional<SurfacePoint>> found(list.rays.size() - first);
  tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t i) {
    const accel::Ray& ray = list.rays[first + i];
    const std::optional<accel::oracle::ExactHit> hit = oracle.closest_hit(ray);
    if (hit) found[i] = point_of(scene, mirrors, ray, *hit, list.samples[first + i]);
  });
  std::vector<SurfacePoint> points;
  for (const std::optional<SurfacePoint>& point : found) {
    if (point) points.push_back(*point);
  }
  return points;
}

void add_reflected(const SurfacePoint& at, RayList& list) {
  add_ray(at, accel::mirrored(at.incoming, at.normal), list);
}

/// Returns a unit vector with density cos / pi in the hemisphere about the unit vector `normal`
/// (Malley's method: a uniform point of the unit disc, lifted to the hemisphere; Pharr, Jakob and
/// Humphreys, Physically Based Rendering, 4th ed., A.5.3).
dvec3 cosine_direction(const dvec3& normal, Random& random) {
  const dvec3 axis = std::abs(normal.x) < 0.5 ? dvec3(1.0, 0.0, 0.0) : dvec3(0.0, 1.0, 0.0);
  const dvec3 tangent = glm::normalize(glm::cross(normal, axis));
  const double radius_2 = random.unit();
  const double radius = std::sqrt(radius_2);
  const double angle = 2.0 * std::numbers::pi * random.unit();
  return tangent * (radius * portable_cos(angle)) +
         glm::cross(normal, tangent) * (radius * portable_sin(angle)) +
         normal * std::sqrt(1.0 - radius_2);
}

/// Adds one ray from each point.
void add_scattered(const std::vector<SurfacePoint>& points, Random& random, RayList& list) {
  for (const SurfacePoint& at : points) {
    add_ray(at, cosine_direction(at.normal, random), list);
  }
}

struct Box {
  dvec3 lower;
  dvec3 size;
};

Box widened(const scenes::Bounds& bounds) {
  const dvec3 size = dvec3(bounds.upper) - dvec3(bounds.lower);
  const double diagonal = glm::length(size);
  const double pad = diagonal > 0.0 ? 0x1p-10 * diagonal : 1.0;
  return {dvec3(bounds.lower) - pad, size + 2.0 * pad};
}

/// Returns a ray that enters through one of the six faces, chosen by area.
accel::Ray line_through(const Box& box, Random& random) {
  const dvec3 areas(box.size.y * box.size.z, box.size.z * box.size.x, box.size.x * box.size.y);
  const double chosen = random.uniform(0.0, areas.x + areas.y + areas.z);
  const int axis = chosen < areas.x ? 0 : chosen < areas.x + areas.y ? 1 : 2;
  const bool upper = random.below(2) == 1;

  dvec3 point = box.lower;
  for (int i = 0; i < 3; ++i) point[i] += box.size[i] * random.unit();
  point[axis] = box.lower[axis] + (upper ? box.size[axis] : 0.0);
  dvec3 inward(0.0);
  inward[axis] = upper ? -1.0 : 1.0;
  const dvec3 direction = cosine_direction(inward, random);

  accel::Ray ray;
  ray.origin = glm::vec3(point - direction * glm::length(box.size));
  ray.direction = glm::vec3(direction);
  return ray;
}

}  // namespace

std::vector<SurfacePoint> surface_points(const scenes::Scene& scene, const MirrorTable& mirrors,
                                         const accel::PrimaryRays& rays) {
  const accel::oracle::Oracle oracle(scene, glm::length(dvec3(rays.eye())));
  std::vector<std::vector<SurfacePoint>> rows(static_cast<std::size_t>(rays.height()));
  tbb::parallel_for(0, rays.height(), [&](int y) {
    rays.for_each(y, y + 1, [&](std::size_t sample, const accel::Ray& ray) {
      const std::optional<accel::oracle::ExactHit> hit = oracle.closest_hit(ray);
      if (!hit) return;
      rows[static_cast<std::size_t>(y)].push_back(point_of(scene, mirrors, ray, *hit, sample));
    });
  });
  std::vector<SurfacePoint> points;
  for (const auto& row : rows) points.insert(points.end(), row.begin(), row.end());
  return points;
}

std::vector<SurfacePoint> in_picture_order(const std::vector<SurfacePoint>& points,
                                           const accel::PrimaryRays& image) {
  std::vector<const SurfacePoint*> of_sample(image.count());
  for (const SurfacePoint& point : points) of_sample[point.sample] = &point;
  std::vector<SurfacePoint> ordered;
  ordered.reserve(points.size());
  for_each_sample(image, [&](int x, int y, int sample) {
    const SurfacePoint* point = of_sample[index_of(image, {x, y, sample})];
    if (point != nullptr) ordered.push_back(*point);
  });
  return ordered;
}

RayList shadow_rays(std::span<const scenes::Light> lights, const std::vector<SurfacePoint>& points,
                    std::size_t per_light) {
  RayList list;
  std::vector<const SurfacePoint*> facing;
  for (std::size_t first = 0; first < lights.size(); first += per_light) {
    const auto light = lights.subspan(first, per_light);
    facing.clear();
    for (const SurfacePoint& at : points) {
      const bool faces = std::ranges::any_of(light, [&](const scenes::Light& point) {
        return glm::dot(dvec3(point.position) - at.beside(), at.normal) > 0.0;
      });
      if (faces) facing.push_back(&at);
    }
    if (facing.empty()) continue;
    if (per_light > 1) list.marks.bundles.push_back({list.pencils.size(), per_light});
    for (const scenes::Light& point : light) {
      const dvec3 position(point.position);
      list.pencils.push_back({list.rays.size(), facing.size(), position, true});
      for (const SurfacePoint* at : facing) {
        add_ray(*at, position - at->beside(), list).t_max =
            accel::t_before_light(at->beside(), position);
      }
    }
  }
  return list;
}

RayList reflection_rays(const std::vector<SurfacePoint>& points) {
  RayList list;
  reserve(points.size(), list);
  for (const SurfacePoint& at : points) add_reflected(at, list);
  return list;
}

RayList mirror_rays(const std::vector<SurfacePoint>& points, const MirrorTable& mirrors,
                    const accel::PrimaryRays& image) {
  struct Reflected {
    std::uint32_t mirror;
    const SurfacePoint* at;
  };
  std::vector<Reflected> reflected;
  for (const SurfacePoint& at : points) {
    const std::uint32_t mirror = mirrors.plane_of(at.primitive);
    if (mirror != MirrorTable::kNone) reflected.push_back({mirror, &at});
  }
  std::ranges::stable_sort(reflected, {}, &Reflected::mirror);
  RayList list;
  reserve(reflected.size(), list);
  const VirtualEye eye(image);
  for (auto first = reflected.begin(); first != reflected.end();) {
    const auto last =
        std::ranges::upper_bound(first, reflected.end(), first->mirror, {}, &Reflected::mirror);
    if (auto behind = eye.behind(mirrors.planes()[first->mirror])) {
      list.views.push_back(std::make_shared<const accel::PrimaryRays>(std::move(behind->view)));
      list.pencils.push_back({list.rays.size(), static_cast<std::size_t>(last - first),
                              behind->place, false, list.views.back().get()});
    }
    for (; first != last; ++first) add_reflected(*first->at, list);
  }
  return list;
}

RayList diffuse_rays(const std::vector<SurfacePoint>& points, std::uint64_t seed) {
  Random random(seed);
  RayList list;
  reserve(points.size(), list);
  add_scattered(points, random, list);
  return list;
}

RayList occlusion_rays(const std::vector<SurfacePoint>& points, int samples, float distance,
                       std::uint64_t seed) {
  Random random(seed);
  RayList list;
  reserve(points.size() * static_cast<std::size_t>(samples), list);
  for (const SurfacePoint& at : points) {
    for (int i = 0; i < samples; ++i) {
      add_ray(at, cosine_direction(at.normal, random), list).t_max = distance;
    }
  }
  return list;
}

RayList path_rays(const scenes::Scene& scene, const MirrorTable& mirrors,
                  std::vector<SurfacePoint> points, int bounces, std::uint64_t seed) {
  Random random(seed);
  RayList list;
  std::optional<accel::oracle::Oracle> oracle;
  for (int bounce = 0; bounce < bounces && !points.empty(); ++bounce) {
    const std::size_t first = list.rays.size();
    add_scattered(points, random, list);
    if (bounce + 1 == bounces) break;
    // The scene determines the oracle's reach: every point is on a primitive, and rays begin
    // slightly beside it.
    if (!oracle)
      oracle.emplace(scene, 2.0 * static_cast<double>(scene.bounds.largest_coordinate()));
    points = points_hit(scene, mirrors, *oracle, list, first);
  }
  return list;
}

RayList random_rays(const scenes::Bounds& box, std::size_t count, std::uint64_t seed) {
  RayList list;
  if (box.empty()) return list;
  const Box around = widened(box);
  Random random(seed);
  list.rays.reserve(count);
  while (list.rays.size() < count) list.rays.push_back(line_through(around, random));
  return list;
}

}  // namespace beambench::rays
