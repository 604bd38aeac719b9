#include "accel/beam/mirror_beams.hpp"

#include <algorithm>
#include <cstdint>

#include <glm/geometric.hpp>

#include "accel/core/tolerance.hpp"

namespace beambench::accel::beam {

using glm::dvec3;

std::optional<MirrorView> view_in(const scenes::PlanarSurface& mirror, const PrimaryRays& rays,
                                  const HitBuffer& hits) {
  const dvec3 eye(rays.eye());
  const double side = glm::dot(eye - mirror.point, mirror.normal) > 0.0 ? 1.0 : -1.0;
  const dvec3 virtual_eye = mirror.point + mirrored(eye - mirror.point, mirror.normal);
  const dvec3 lift = side * mirror_lift(mirror.bounds) * mirror.normal;
  MirrorView view{rays.mirrored(mirror.point, mirror.normal), virtual_eye + lift, {}, {}};
  rays.for_each(0, rays.height(), [&](std::size_t index, const Ray& ray) {
    const auto hit = hits.get(index);
    if (!hit) return;
    if (!std::binary_search(mirror.polygons.begin(), mirror.polygons.end(), hit->primitive)) return;
    const dvec3 direction(ray.direction);
    Ray& reflected = view.rays.emplace_back();
    reflected.origin = glm::vec3(eye + double{hit->t} * direction + lift);
    reflected.direction = glm::vec3(mirrored(direction, mirror.normal));
    view.samples.push_back(static_cast<std::uint32_t>(index));
  });
  if (view.rays.empty()) return std::nullopt;
  return view;
}

}  // namespace beambench::accel::beam
