#pragma once
// Checks the hits returned by a structure before they are used to compute anything.

#include <cmath>
#include <stdexcept>
#include <string>

#include "accel/core/hit_buffer.hpp"
#include "accel/core/ray.hpp"
#include "accel/core/registry.hpp"
#include "scenes/scene.hpp"

namespace beambench::rays {

/// Thrown if a structure returns a hit that is impossible for its ray. The message is one sentence
/// that names the structure, the ray, the returned hit and what was expected; the command line
/// prints it and exits with 1.
class InvalidHit : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Checks the hits of one structure over one scene: secondary rays, normals and colors may only be
/// computed from hits that pass. The differ decides whether a hit is correct.
class HitCheck {
 public:
  /// `structure` is the subject of the message: "structure 'samet:max_level=6'".
  explicit HitCheck(const scenes::Scene& scene, std::string structure = "the structure")
      : HitCheck(scene.primitives.size(), std::move(structure)) {}
  /// Checks hits over a scene of which only the number of primitives is known.
  HitCheck(std::size_t primitives, std::string structure)
      : primitives_(primitives), structure_(std::move(structure)) {}
  /// Names the choice and, if it comes from a plug-in, its file in messages.
  HitCheck(const scenes::Scene& scene, const accel::StructureChoice& choice);

  /// Returns whether the hit is possible for the ray: one of the scene's primitives, at a finite t
  /// in [t_min, t_max].
  bool passes(const accel::Ray& ray, const accel::Hit& hit) const {
    return hit.primitive < primitives_ && std::isfinite(hit.t) && hit.t >= ray.t_min &&
           hit.t <= ray.t_max;
  }
  /// Throws InvalidHit unless `passes`.
  void require(const accel::Ray& ray, const accel::Hit& hit) const {
    if (!passes(ray, hit)) fail(ray, hit, "");
  }
  /// Throws InvalidHit naming the pixel unless every hit of an image passes. Its rays, `ray_of(x,
  /// y, sample)`, have the interval [0, infinity].
  template <class RayOf>
  void require(const accel::HitBuffer& hits, RayOf ray_of) const {
    for (int y = 0; y < hits.height(); ++y) {
      for (int x = 0; x < hits.width(); ++x) {
        for (int sample = 0; sample < hits.samples(); ++sample) {
          const auto hit = hits.get(hits.index(x, y, sample));
          if (!hit || passes(accel::Ray(), *hit)) continue;
          fail(ray_of(x, y, sample), *hit, pixel_text(x, y, sample));
        }
      }
    }
  }
  void require(const accel::HitBuffer& hits, const accel::PrimaryRays& rays) const {
    require(hits, [&](int x, int y, int sample) { return rays.ray(x, y, sample); });
  }

 private:
  static std::string pixel_text(int x, int y, int sample);
  [[noreturn]] void fail(const accel::Ray& ray, const accel::Hit& hit,
                         const std::string& where) const;

  std::size_t primitives_;
  std::string structure_;
};

}  // namespace beambench::rays
