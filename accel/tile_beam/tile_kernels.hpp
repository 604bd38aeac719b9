#pragma once
// Traces tiles and rays through the hierarchy, compiled for several instruction sets.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "accel/core/hit_buffer.hpp"
#include "accel/core/primary_rays.hpp"
#include "accel/core/trace_step.hpp"
#include "accel/core/work_counters.hpp"
#include "accel/tile_beam/sample_raster.hpp"
#include "accel/tile_beam/tile_hierarchy.hpp"
#include "accel/tile_beam/tile_image.hpp"
#include "accel/tile_beam/tile_view.hpp"
#include "accel/tile_beam/visible_backs.hpp"

namespace beambench::accel::tile_beam {

/// The queries of single rays under one counting policy. Must not be used for empty hierarchies or
/// for rays that ProbeRay cannot probe.
template <class Counting>
struct TileRayQueries {
  std::optional<Hit> (*closest)(const TileHierarchy&, const scenes::Scene&, const Ray&, Counting&);
  bool (*any)(const TileHierarchy&, const scenes::Scene&, const Ray&, Counting&);
};

/// The queries of lists of rays, for nonempty hierarchies. Rays that ProbeRay cannot probe are
/// skipped; the functions return whether there are any such rays.
template <class Counting>
struct TileListQueries {
  /// Writes the hits from `first` of the buffer on.
  bool (*closest_hits)(const TileHierarchy&, const scenes::Scene&, std::span<const Ray>,
                       const HitSpan& buffer, std::size_t first, Counting&);
  /// Writes 1 for a hit and 0 for a miss.
  bool (*any_hits)(const TileHierarchy&, const scenes::Scene&, std::span<const Ray>,
                   std::span<std::uint8_t> hits, Counting&);
};

/// The scene, the view and the result of drawing.
struct TilePicture {
  const TileHierarchy& hierarchy;
  const scenes::Scene& scene;
  const PrimaryRays& rays;
  const SampleRaster& raster;
  const VisibleBacks& backs;
};

/// Draws one tile of a picture; `image` is its memory. If the buffer is large, other threads may
/// see hits only after hwy::FlushStream.
template <class Counting>
struct TileDrawing {
  void (*draw)(const TilePicture&, const TileView&, TileImage&, const HitSpan&, Counting&);
};

/// The kernels for one instruction set.
struct TileKernels : TileRayQueries<NoCounting>,
                     TileRayQueries<WorkCounters>,
                     TileRayQueries<StepRecorder>,
                     TileListQueries<NoCounting>,
                     TileListQueries<WorkCounters>,
                     TileDrawing<NoCounting>,
                     TileDrawing<WorkCounters> {
  std::int64_t target;  ///< HWY_TARGET; hwy::TargetName returns its name

  template <class Counting>
  const TileRayQueries<Counting>& queries() const {
    return *this;
  }
  template <class Counting>
  const TileListQueries<Counting>& lists() const {
    return *this;
  }
  template <class Counting>
  const TileDrawing<Counting>& drawing() const {
    return *this;
  }
};

/// Returns the kernels for this machine's best instruction set among the Highway targets `targets`,
/// as returned by `targets_of`.
const TileKernels& tile_kernels_for(std::int64_t targets);

}  // namespace beambench::accel::tile_beam
