#include "harness/render/recorded_picture.hpp"

#include <utility>

#include "harness/render/whitted_picture.hpp"

namespace beambench::render {

RecordedPicture record_picture(const scenes::Scene& scene, const accel::Accelerator& structure,
                               const accel::PrimaryRays& rays, accel::HitBuffer eye,
                               const WhittedOptions& options, rays::HitCheck check) {
  RecordedPicture picture{std::move(eye), {}, Image(rays.width(), rays.height()), {}};
  auto& [reflected_rays, refracted_rays, shadow_rays] = picture.asked;
  const RecordedQueries reflected(structure, reflected_rays);
  const RecordedQueries refracted(structure, refracted_rays);
  const RecordedQueries shadow(structure, shadow_rays);
  const Whitted tracer(scene, {&reflected, &refracted, &shadow}, options, std::move(check));
  picture.census = draw_in_order(tracer, eye_rays(rays), picture.eye, picture.image);
  return picture;
}

}  // namespace beambench::render
