#include "harness/render/light_pencil.hpp"

#include <algorithm>

#include "accel/core/inspector_of.hpp"
#include "harness/rays/ray_generators.hpp"

namespace beambench::render {

LightPencil light_pencil(const accel::Accelerator& accelerator, const scenes::Scene& scene,
                         const accel::PrimaryRays& image, const scenes::Light& light) {
  const rays::RayList shadows = rays::shadow_rays(
      scene.lights, rays::in_picture_order(rays::surface_points(scene, image), image));
  const auto pencil =
      std::ranges::find(shadows.pencils, glm::dvec3(light.position), &accel::Pencil::apex);
  if (pencil == shadows.pencils.end()) return {};
  const accel::RayBatch all = shadows.batch();
  const accel::Pencil alone{0, pencil->count, pencil->apex, pencil->toward};
  const accel::RayBatch batch{all.rays.subspan(pencil->first, pencil->count),
                              {&alone, 1},
                              all.samples.subspan(pencil->first, pencil->count),
                              &image};
  return {{batch.rays.begin(), batch.rays.end()},
          {batch.samples.begin(), batch.samples.end()},
          accel::inspector_of(accelerator).places(batch)};
}

}  // namespace beambench::render
