#pragma once
// The whole ray tracer: light, shadow, mirrors and glass over any structure.

#include <optional>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/accelerator.hpp"
#include "harness/rays/hit_check.hpp"
#include "harness/render/ray_census.hpp"
#include "harness/render/shadows.hpp"
#include "harness/render/texture.hpp"
#include "scenes/scene.hpp"

namespace beambench::render {

/// The structure for each kind of rays: one for all, or others that watch its queries.
struct Answerers {
  const accel::Accelerator* reflected;
  const accel::Accelerator* refracted;
  const accel::Accelerator* shadow;
};

/// Recursive ray tracing (Whitted, "An improved illumination model for shaded display", CACM 23(6),
/// 1980; chapter 4 of the thesis) with NFF's surfaces: the diffuse factor times the color under
/// ambient light and every light that is seen; the specular factor for highlights (Phong) and for
/// what a mirror ray sees; the transmittance for what a ray refracted by Snell's law sees, or at
/// total reflection, where there is no such ray, for what the mirror ray sees.
///
/// Colors of scenes are display values, as they were in 1987, and are decoded to linear light. A
/// light without a color of its own (white) has 1 / sqrt(lights), as NFF has it. All in double, in
/// one order: structures that return the same hits give the same bits.
class Whitted {
 public:
  /// Scene and structure must outlive this. `check` names the structure where it fails.
  Whitted(const scenes::Scene& scene, const accel::Accelerator& structure,
          const WhittedOptions& options)
      : Whitted(scene, structure, options, rays::HitCheck(scene)) {}
  Whitted(const scenes::Scene& scene, const accel::Accelerator& structure,
          const WhittedOptions& options, rays::HitCheck check)
      : Whitted(scene, {&structure, &structure, &structure}, options, std::move(check)) {}
  Whitted(const scenes::Scene& scene, const Answerers& answerers, const WhittedOptions& options,
          rays::HitCheck check);

  /// What a part of a picture, made by one thread in one order, remembers and counts.
  struct Progress {
    ShadowCache shadows;
    RayCensus census;
  };
  Progress begin() const;

  /// Linear light along a camera ray that found `hit`. Throws InvalidHit where this hit or that of
  /// a following ray is invalid.
  glm::dvec3 camera_ray_color(const accel::Ray& ray, const std::optional<accel::Hit>& hit,
                              Progress& progress) const;

  const Shadows& shadows() const { return shadows_; }

 private:
  struct Kind;
  struct Path;
  struct Place;
  glm::dvec3 color_along(const accel::Ray& ray, const std::optional<accel::Hit>& hit,
                         const Path& path, Progress& progress) const;
  Place place_of(const accel::Ray& ray, const accel::Hit& hit) const;
  glm::dvec3 lit(const Place& at, const Path& path, Progress& progress) const;
  glm::dvec3 spawned(const Place& at, const Path& path, Progress& progress) const;
  glm::dvec3 reflected(const Place& at, const Path& path, double share, Progress& progress) const;
  bool enters(const Place& at, const Path& path) const;
  glm::dvec3 traced(const Kind& kind, const glm::dvec3& origin, const glm::dvec3& direction,
                    const Path& path, Progress& progress) const;

  const scenes::Scene* scene_;
  Answerers answerers_;
  rays::HitCheck check_;
  WhittedOptions options_;
  Shadows shadows_;
  TextureSpace textures_;
  std::vector<glm::dvec3> light_colors_;
  glm::dvec3 background_;
};

}  // namespace beambench::render
