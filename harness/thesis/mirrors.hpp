#pragma once
// Traces the views in planar mirrors and through planar glass, with beams and with individual rays.

#include <array>
#include <cstddef>
#include <vector>

#include "accel/beam/beam_tracer.hpp"
#include "scenes/scene.hpp"

namespace beambench::thesis {

/// The view in one mirror, or through one plane of glass, or the sum of several. Times are medians,
/// in milliseconds.
struct MirrorResult {
  std::size_t polygons = 0;
  std::size_t samples = 0;
  std::size_t hits = 0;
  std::size_t different = 0;  ///< samples for which rays and beams find different hits
  double rays_ms = 0.0;
  double beams_ms = 0.0;

  MirrorResult& operator+=(const MirrorResult& other);
};

/// The upper ends of the classes of angles of incidence, in degrees.
inline constexpr std::array<int, 6> kIncidence{15, 30, 45, 60, 75, 90};

/// The refracted rays that a plane of glass transmits, by the angle at which camera rays meet it.
struct GlassResult : MirrorResult {
  struct Class {
    std::size_t samples = 0;
    std::size_t alone = 0;  ///< rays traced outside any beam
  };
  std::array<Class, kIncidence.size()> by_angle{};

  GlassResult& operator+=(const GlassResult& other);
};

struct MirrorComparison {
  std::size_t mirrors;             ///< planar mirrors of the scene
  std::size_t glass;               ///< its planes of glass
  std::vector<MirrorResult> seen;  ///< the mirrors visible in the image
  std::vector<GlassResult> seen_through;
};

/// Traces the reflections in each mirror in beams from the mirror's virtual eye (Heckbert and
/// Hanrahan 1984) and ray by ray through the same octree, each `repetitions` times; then traces the
/// rays that enter each plane of glass in the same two ways. `hits` are the hits of `rays`.
MirrorComparison compare_mirrors(const accel::beam::BeamTracer& tracer, const scenes::Scene& scene,
                                 const accel::PrimaryRays& rays, const accel::HitBuffer& hits,
                                 int repetitions);

}  // namespace beambench::thesis
