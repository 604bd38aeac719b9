#include "harness/shade/recorded_picture.hpp"

#include <utility>

#include "harness/shade/whitted_picture.hpp"

namespace beambench {

RecordedPicture record_picture(const Scene& scene, const Accelerator& structure,
                               const PrimaryRays& rays, HitBuffer eye,
                               const WhittedOptions& options, HitCheck check) {
  RecordedPicture picture{std::move(eye), {}, Image(rays.width(), rays.height()), {}};
  auto& [reflected_rays, refracted_rays, shadow_rays] = picture.asked;
  const RecordedQueries reflected(structure, reflected_rays);
  const RecordedQueries refracted(structure, refracted_rays);
  const RecordedQueries shadow(structure, shadow_rays);
  const Whitted tracer(scene, {&reflected, &refracted, &shadow}, options, std::move(check));
  picture.census = draw_in_order(tracer, eye_rays(rays), picture.eye, picture.image);
  return picture;
}

}  // namespace beambench
