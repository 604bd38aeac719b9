#include "harness/rays/virtual_eye.hpp"

#include <cmath>

#include <glm/geometric.hpp>

#include "accel/core/tolerance.hpp"

namespace beambench::rays {

PlaneTable::PlaneTable(const scenes::Scene& scene, std::vector<scenes::PlanarSurface> planes)
    : planes_(std::move(planes)) {
  if (planes_.empty()) return;
  plane_of_.assign(scene.primitives.size(), kNone);
  for (std::uint32_t i = 0; i < planes_.size(); ++i) {
    for (const scenes::PrimitiveId id : planes_[i].polygons) plane_of_[id] = i;
  }
}

std::optional<VirtualEye> VirtualEye::behind(const scenes::PlanarSurface& mirror) const {
  const double lift = accel::mirror_lift(mirror.bounds);
  const glm::dvec3 from_mirror = place - mirror.point;
  const double distance = glm::dot(from_mirror, mirror.normal);
  if (std::abs(distance) <= 4.0 * (lift + 0x1p-20 * glm::length(from_mirror))) return std::nullopt;
  VirtualEye eye(view.mirrored(mirror.point, mirror.normal));
  eye.place = mirror.point + accel::mirrored(from_mirror, mirror.normal) +
              std::copysign(lift, distance) * mirror.normal;
  return eye;
}

}  // namespace beambench::rays
