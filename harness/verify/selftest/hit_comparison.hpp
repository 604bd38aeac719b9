#pragma once
// A structure's answers beside the right ones.

#include <span>
#include <string>
#include <vector>

#include "accel/core/accelerator.hpp"
#include "accel/core/registry.hpp"
#include "accel/exhaustive/exhaustive.hpp"

namespace beambench::verify {

/// With all its bits, so that it can be asked again.
std::string show(const accel::Ray& ray);
std::string show(const std::optional<accel::Hit>& hit);

/// The right answers over a scene, by what the structure claims: every bit those of exhaustive
/// search, or right by the differ's classes. Each method tells the first wrong answer in a
/// sentence, or nothing when all are right. The scene outlives it.
class HitComparison {
 public:
  HitComparison(const scenes::Scene& scene, accel::Conformance conformance)
      : scene_(&scene), exhaustive_(scene), conformance_(conformance) {}

  /// Closest and any hits of single rays. Where every bit must be equal, each ray is asked once
  /// more so that it ends, and so that it begins, exactly where it hits.
  std::string single_rays(const accel::Accelerator& structure,
                          std::span<const accel::Ray> rays) const;
  /// The closest hits of an image, as a whole. `may_graze`: more grazes than the differ's budget
  /// are right, as they are where the eye lies on a surface.
  std::string image(const accel::Accelerator& structure, const accel::PrimaryRays& rays,
                    bool may_graze) const;

  /// How many of the rays hit something.
  std::size_t count_hits(std::span<const accel::Ray> rays) const;

 private:
  std::string same_bits(const accel::Accelerator& structure, const accel::Ray& ray) const;
  std::string by_the_differ(const accel::Accelerator& structure,
                            std::span<const accel::Ray> rays) const;

  const scenes::Scene* scene_;
  accel::exhaustive::Exhaustive exhaustive_;
  accel::Conformance conformance_;
};

}  // namespace beambench::verify
