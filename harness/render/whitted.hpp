#pragma once
// The whole ray tracer: light, shadow, mirrors and glass over any structure.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/accelerator.hpp"
#include "accel/core/primary_rays.hpp"
#include "harness/rays/hit_check.hpp"
#include "harness/render/places.hpp"
#include "harness/render/ray_census.hpp"
#include "harness/render/shaded_scene.hpp"
#include "harness/render/shadows.hpp"
#include "scenes/scene.hpp"

namespace beambench::render {

/// The structure for each kind of rays: the same for all kinds, or wrappers that observe its
/// queries.
struct RayStructures {
  const accel::Accelerator* reflected;
  const accel::Accelerator* refracted;
  const accel::Accelerator* shadow;
};

/// Camera rays of an image, and their hits. All three lists have the same length.
struct CameraRays {
  const accel::PrimaryRays* image;
  std::span<const accel::Ray> rays;
  std::span<const std::uint32_t> samples;  ///< their samples, as numbered by a HitBuffer
  std::span<const std::optional<accel::Hit>> hits;
};

/// Recursive ray tracing (Whitted, "An improved illumination model for shaded display", CACM 23(6),
/// 1980; chapter 4 of the thesis) with NFF's surfaces: the diffuse factor times the color under
/// ambient light and every visible light; the specular factor for highlights (Phong) and for the
/// light of the mirror ray; the transmittance for the light of the ray refracted by Snell's law, or
/// of the mirror ray at total reflection.
///
/// Colors of scenes are display values, as was usual in 1987, and are decoded to linear light. A
/// light without a stated color is white, with intensity 1 / sqrt(lights), as in NFF. Everything is
/// computed in double, in a fixed order: structures that return the same hits yield the same bits.
///
/// Rays are traced in waves (an idea of Laine, Karras and Aila, "Megakernels considered harmful",
/// HPG 2013, for other hardware): the camera rays of a part of the picture, then from their hits
/// all shadow rays of each light, all mirror rays and all refracted rays, and so on from the hits
/// of these rays. So a structure receives batches. The shadow rays of a light are a pencil, and so
/// are mirror rays through one virtual eye, which come from the camera via planar mirrors only.
/// Rays that a plane has refracted, and that came from the camera via planes only, are marked as
/// refracted rays. A sample's light is summed in the order of recursive ray tracing, whatever the
/// parts and batches.
class Whitted {
 public:
  /// Scene and structure must outlive this object. `check` names the structure in its errors.
  Whitted(const scenes::Scene& scene, const accel::Accelerator& structure,
          const WhittedOptions& options)
      : Whitted(scene, structure, options, rays::HitCheck(scene)) {}
  Whitted(const scenes::Scene& scene, const accel::Accelerator& structure,
          const WhittedOptions& options, rays::HitCheck check)
      : Whitted(std::make_shared<const ShadedScene>(scene), {&structure, &structure, &structure},
                options, std::move(check)) {}
  Whitted(std::shared_ptr<const ShadedScene> scene, const RayStructures& structures,
          const WhittedOptions& options, rays::HitCheck check);

  /// The memory and counts of one part of a picture, drawn by one thread in a fixed order.
  struct Progress {
    ShadowCache shadows;
    RayCensus census;
  };
  Progress begin() const;

  /// Computes the linear light along each camera ray, written to `colors`, which must have the same
  /// size. Whatever the number of rays, memory is that of one batch (`WhittedOptions`) for each
  /// depth. Throws InvalidHit if a hit of a camera ray or of a secondary ray is invalid.
  void trace_light(const CameraRays& camera, std::span<glm::dvec3> colors,
                   Progress& progress) const;

  const Shadows& shadows() const { return shadows_; }
  /// Returns the maximum number of rays in a batch.
  int batch() const { return options_.batch; }
  /// Returns whether counts depend on the order of the rays.
  bool remembers_shadows() const { return options_.shadows == ShadowMethod::kCache; }

 private:
  struct Part;
  struct Path;
  struct Found;
  struct Spawned;
  void trace_wave(const Part& wave, int depth, std::span<glm::dvec3> colors,
                  Progress& progress) const;
  void trace_part(const Part& part, int depth, std::span<glm::dvec3> colors,
                  Progress& progress) const;
  Found find_places(const Part& part) const;
  std::vector<glm::dvec3> lit(const Found& found, const accel::PrimaryRays& image, int depth,
                              Progress& progress) const;
  void add_light(std::size_t light, const Found& found, std::span<const glm::dvec3> matte,
                 const accel::PrimaryRays& image, int depth, std::span<glm::dvec3> sums,
                 Progress& progress) const;
  Spawned spawned(const Found& found, const Part& part, Progress& progress) const;
  bool enters(const Found& found, std::size_t place) const;

  std::shared_ptr<const ShadedScene> shaded_;
  const scenes::Scene* scene_;
  RayStructures structures_;
  rays::HitCheck check_;
  WhittedOptions options_;
  Shadows shadows_;
  const PlaceKernels* kernels_;
};

}  // namespace beambench::render
