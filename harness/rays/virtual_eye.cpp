#include "harness/rays/virtual_eye.hpp"

#include "accel/core/tolerance.hpp"

namespace beambench::rays {

MirrorTable::MirrorTable(const scenes::Scene& scene)
    : mirrors_(scenes::planar_mirrors(scene)), lift_(accel::surface_lift(scene)) {
  if (mirrors_.empty()) return;
  mirror_of_.assign(scene.primitives.size(), kNone);
  for (std::uint32_t i = 0; i < mirrors_.size(); ++i) {
    for (const scenes::PrimitiveId id : mirrors_[i].polygons) mirror_of_[id] = i;
  }
}

VirtualEye VirtualEye::behind(const scenes::PlanarMirror& mirror, bool on_normals_side,
                              double lift) const {
  VirtualEye eye(view.mirrored(mirror.point, mirror.normal));
  eye.place = mirror.point + accel::mirrored(place - mirror.point, mirror.normal) +
              (on_normals_side ? lift : -lift) * mirror.normal;
  return eye;
}

}  // namespace beambench::rays
