#pragma once
// A structure's answers beside the right ones.

#include <span>
#include <string>
#include <vector>

#include "accel/accelerator.hpp"
#include "accel/exhaustive/exhaustive.hpp"
#include "accel/registry.hpp"

namespace beambench {

/// With all its bits, so that it can be asked again.
std::string show(const Ray& ray);
std::string show(const std::optional<Hit>& hit);

/// The right answers over a scene, by what the structure claims: every bit those of exhaustive
/// search, or right by the differ's classes. Each method tells the first wrong answer in a
/// sentence, or nothing when all are right. The scene outlives it.
class HitComparison {
 public:
  HitComparison(const Scene& scene, Conformance conformance)
      : scene_(&scene), exhaustive_(scene), conformance_(conformance) {}

  /// Closest and any hits of single rays. Where every bit must be equal, each ray is asked once
  /// more so that it ends, and so that it begins, exactly where it hits.
  std::string single_rays(const Accelerator& structure, std::span<const Ray> rays) const;
  /// The closest hits of an image, as a whole. `may_graze`: more grazes than the differ's budget
  /// are right, as they are where the eye lies on a surface.
  std::string image(const Accelerator& structure, const PrimaryRays& rays, bool may_graze) const;

  /// How many of the rays hit something.
  std::size_t count_hits(std::span<const Ray> rays) const;

 private:
  std::string same_bits(const Accelerator& structure, const Ray& ray) const;
  std::string by_the_differ(const Accelerator& structure, std::span<const Ray> rays) const;

  const Scene* scene_;
  Exhaustive exhaustive_;
  Conformance conformance_;
};

}  // namespace beambench
