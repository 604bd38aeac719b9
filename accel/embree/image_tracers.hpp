#pragma once
// Traces whole images with Embree. Rays are generated and hits are written by SIMD, compiled for
// several instruction sets, so that measurements show Embree and not the generation of rays.

#include <cstdint>

#include "accel/core/hit_buffer.hpp"
#include "accel/core/primary_rays.hpp"
#include "accel/embree/native_scene.hpp"

namespace beambench::accel::embree {

/// Rows of an image, from `top` up to but not including `bottom`.
struct Band {
  int top;
  int bottom;
};

/// The size of the tiles in which an image is traced; the part of the scene needed for a tile stays
/// in the caches.
inline constexpr int kTile = 16;

/// Returns the number of rows of tiles in an image.
int tile_rows(const PrimaryRays& rays);
/// Returns the rows of pixels in tile rows `begin` up to but not including `end`.
Band band_of(const PrimaryRays& rays, int begin, int end);

/// The image tracers for one instruction set. The rays equal those of `PrimaryRays::ray` bit for
/// bit: they are computed in double by the same operations, and each component is rounded once to
/// float.
struct ImageTracers {
  /// `band` begins at a multiple of `kTile`.
  using Trace = void (*)(const NativeScene& scene, Context& context, const PrimaryRays& rays,
                         const Band& band, const HitSpan& buffer);
  Trace single;  ///< ray by ray, in blocks of 4x4 pixels
  Trace packet4;
  Trace packet8;
  Trace packet16;
  /// All rays of a tile at once, in packets as wide as the instruction set's registers, because
  /// Embree would first copy packets of any other width. nullptr in Embree 4.
  Trace stream;
  /// Generates the rays in packets of 16 and stores a miss for each, without a query.
  void (*untraced)(const OwnerTable& owners, const PrimaryRays& rays, const Band& band,
                   const HitSpan& buffer);
  std::int64_t target;  ///< HWY_TARGET; hwy::TargetName returns its name
};

/// Returns the tracers for the best of Highway's `targets` that this machine supports.
const ImageTracers& image_tracers(std::int64_t targets);

}  // namespace beambench::accel::embree
