#include "harness/rays/virtual_eye.hpp"

#include <cmath>

#include <glm/geometric.hpp>

#include "accel/core/tolerance.hpp"

namespace beambench::rays {

MirrorTable::MirrorTable(const scenes::Scene& scene) : mirrors_(scenes::planar_mirrors(scene)) {
  if (mirrors_.empty()) return;
  mirror_of_.assign(scene.primitives.size(), kNone);
  for (std::uint32_t i = 0; i < mirrors_.size(); ++i) {
    for (const scenes::PrimitiveId id : mirrors_[i].polygons) mirror_of_[id] = i;
  }
}

std::optional<VirtualEye> VirtualEye::behind(const scenes::PlanarMirror& mirror) const {
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
