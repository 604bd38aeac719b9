#pragma once
// Tiles and rays through the hierarchy, compiled for several instruction sets.

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

/// The queries of single rays under one counting policy. Not for empty hierarchies, nor for rays
/// that ProbeRay cannot probe.
template <class Counting>
struct TileRayQueries {
  std::optional<Hit> (*closest)(const TileHierarchy&, const scenes::Scene&, const Ray&, Counting&);
  bool (*any)(const TileHierarchy&, const scenes::Scene&, const Ray&, Counting&);
};

/// Those of lists of rays, for hierarchies that are not empty. Rays that ProbeRay cannot probe are
/// left out; they return whether there are some.
template <class Counting>
struct TileListQueries {
  /// The hits are written from `first` of the buffer on.
  bool (*closest_hits)(const TileHierarchy&, const scenes::Scene&, std::span<const Ray>,
                       const HitSpan& buffer, std::size_t first, Counting&);
  /// 1 for a hit and 0 for none.
  bool (*any_hits)(const TileHierarchy&, const scenes::Scene&, std::span<const Ray>,
                   std::span<std::uint8_t> hits, Counting&);
};

/// What is drawn, and from where.
struct TilePicture {
  const TileHierarchy& hierarchy;
  const scenes::Scene& scene;
  const PrimaryRays& rays;
  const SampleRaster& raster;
  const VisibleBacks& backs;
};

/// Draws one tile of a picture; the image is its memory. Where the buffer is large, hits may be
/// seen by other threads only after hwy::FlushStream.
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
  std::int64_t target;  ///< HWY_TARGET: hwy::TargetName gives its name

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

/// Those for the best instruction set that this machine has among some: Highway's targets, as
/// `targets_of` gives them.
const TileKernels& tile_kernels_for(std::int64_t targets);

}  // namespace beambench::accel::tile_beam
