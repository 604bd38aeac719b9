#include "harness/experiments/sparse_image.hpp"

#include <algorithm>

#include "harness/rays/hit_check.hpp"
#include "harness/render/shading.hpp"

namespace beambench::experiments {

render::Image sparse_image(const scenes::Scene& scene, const accel::PrimaryRays& rays,
                           const accel::beam::SparseSamples& samples) {
  rays::HitCheck(scene, "structure 'beam'").require(samples.hits, rays);
  const glm::vec3 miss = render::background_color(scene);
  render::Image image(rays.width(), rays.height());
  for (int y = 0; y < rays.height(); ++y) {
    for (int x = 0; x < rays.width(); ++x) {
      glm::vec3 color(0.0F);
      float covered = 0.0F;
      for (int sample = 0; sample < rays.samples(); ++sample) {
        const std::size_t index = samples.hits.index(x, y, sample);
        if (samples.number[index] == 0) continue;
        const float part = 1.0F / static_cast<float>(samples.number[index]);
        const auto hit = samples.hits.get(index);
        color += part * (hit ? render::preview_color(scene, rays.ray(x, y, sample), *hit) : miss);
        covered += part;
      }
      image.at(x, y) = covered > 1.0F ? color / covered : color + (1.0F - covered) * miss;
    }
  }
  return image;
}

}  // namespace beambench::experiments
