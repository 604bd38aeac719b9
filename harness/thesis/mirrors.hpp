#pragma once
// Reflections in planar mirrors, by beams and by individual reflected rays.

#include <cstddef>
#include <vector>

#include "accel/beam/beam_tracer.hpp"
#include "scenes/scene.hpp"

namespace beambench::thesis {

/// The view in one mirror, or the sum of several. Times are medians, in milliseconds.
struct MirrorResult {
  std::size_t polygons = 0;
  std::size_t samples = 0;
  std::size_t hits = 0;
  std::size_t different = 0;  ///< samples for which rays and beams find different hits
  double rays_ms = 0.0;
  double beams_ms = 0.0;

  MirrorResult& operator+=(const MirrorResult& other);
};

struct MirrorComparison {
  std::size_t mirrors;             ///< planar mirrors of the scene
  std::vector<MirrorResult> seen;  ///< those visible in the image
};

/// Traces the reflections in each mirror in beams from the mirror's virtual eye (Heckbert and
/// Hanrahan 1984) and ray by ray through the same octree, each `repetitions` times. `hits` are
/// those of `rays`.
MirrorComparison compare_mirrors(const accel::beam::BeamTracer& tracer, const scenes::Scene& scene,
                                 const accel::PrimaryRays& rays, const accel::HitBuffer& hits,
                                 int repetitions);

}  // namespace beambench::thesis
