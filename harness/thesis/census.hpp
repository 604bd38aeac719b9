#pragma once
// Counts the rays of the whole ray tracer by kind, and measures their time.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "accel/core/registry.hpp"
#include "accel/core/statistics.hpp"
#include "harness/base/progress.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/render/picture/image.hpp"
#include "harness/render/ray_census.hpp"
#include "harness/render/shadows.hpp"
#include "harness/render/whitted_picture.hpp"
#include "harness/thesis/counted_queries.hpp"

namespace beambench::thesis {

struct CensusOptions {
  render::WhittedOptions whitted;
  /// Use the rules of Haines's Standard Procedural Databases: rays through the corners of pixels,
  /// and mirror rays at all glass.
  bool spd_rules = false;
  render::ShadingOrder order = render::ShadingOrder::kRows;
  int threads = 0;  ///< see `accel::thread_count`
  /// Count the structure's work; times then include the counting.
  bool count_work = false;
};

/// The same picture with all rays traced, whatever their weight.
struct FullPicture {
  std::uint64_t rays;
  double picture_ms;
  double error;  ///< error of the picture with the reduced rays: `root_mean_square_error`
};

/// Facts about a structure, and its work over all rays of a picture.
struct StructureWork {
  accel::Statistics statistics;
  QueryWork queries;  ///< of shadow rays, only up to their first hit (`CountedShadows`)
};

/// The rays and times of one picture.
struct CensusResult {
  std::string scene;
  std::size_t lights;
  render::RayCensus census;
  double build_ms;
  double eye_ms;          ///< primary rays
  double preparation_ms;  ///< light buffers
  double picture_ms;      ///< everything except the primary rays
  std::size_t shadow_bytes;
  std::optional<FullPicture> full;    ///< if `min_weight` is positive
  std::optional<StructureWork> work;  ///< with `count_work`
  render::Image picture;
};

/// Draws the picture and, if `min_weight` is positive, draws it again with all rays. `progress`
/// gets one cell for each picture. Throws rays::InvalidHit.
CensusResult take_census(const accel::StructureChoice& choice, const scenes::Scene& scene,
                         const rays::ImageOfRays& image, const CensusOptions& options,
                         base::Progress& progress);

}  // namespace beambench::thesis
