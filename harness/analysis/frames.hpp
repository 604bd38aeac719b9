#pragma once
// Scenes that move: what a structure costs in each frame, updated from the first frame or built
// anew, and after how many frames a new one is worth its build.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/analysis/ratio.hpp"
#include "harness/measure/record/run_log.hpp"

namespace beambench::analysis {

/// The times of one frame, in milliseconds: a median, and a mean over blocks.
struct FrameCost {
  double ready_ms;  ///< of the build, or of the update
  double trace_ms;
  std::optional<double> sah_cost;  ///< of the hierarchy, where it states one

  double total_ms() const { return ready_ms + trace_ms; }
};

/// A structure in one frame, both ways.
struct FrameComparison {
  std::uint32_t frame;
  FrameCost updated;
  FrameCost built;
  TimeRatio total;  ///< of the updated structure over that of the new one
  TimeRatio trace;  ///< the same: how much the update costs the rays
};

/// A structure with the same rays over the frames of a scene.
struct FrameSeries {
  std::string contender;  ///< with its parameters, apart from `update`
  std::string subject;    ///< scene and rays: `waving-sheet/default/640x480/1/primary`
  std::vector<FrameComparison> frames;  ///< ascending
};

/// The number of frames after which a structure should be built anew.
struct RebuildInterval {
  std::uint32_t frames;  ///< one build for so many frames, the others are updates
  double mean_ms;        ///< of a frame then
  bool is_all = false;   ///< no build after the first one, in as many frames as were measured
};

/// Returns the structures of a run that were measured both ways, in the order of the run. Cells
/// with wrong hits are left out.
std::vector<FrameSeries> frame_series(const measure::Run& run);

/// Returns the interval of the least mean time per frame: a build, and an update in each frame
/// after it, each as dear as so many frames after frame 0. Frames between measured ones are
/// interpolated linearly.
RebuildInterval rebuild_interval(const FrameSeries& series);

}  // namespace beambench::analysis
