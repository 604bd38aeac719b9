#pragma once
// Animated scenes: the cost of a structure in each frame, updated from the first frame or rebuilt,
// and the number of frames after which rebuilding pays off.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/analysis/ratio.hpp"
#include "harness/measure/record/run_log.hpp"

namespace beambench::analysis {

/// The times of one frame, in milliseconds: a median, or a mean over blocks.
struct FrameCost {
  double ready_ms;  ///< time of the build, or of the update
  double trace_ms;
  std::optional<double> sah_cost;  ///< SAH cost of the hierarchy, if it is reported

  double total_ms() const { return ready_ms + trace_ms; }
};

/// A structure in one frame, updated and rebuilt.
struct FrameComparison {
  std::uint32_t frame;
  FrameCost updated;
  FrameCost built;
  TimeRatio total;  ///< updated structure over rebuilt one
  TimeRatio trace;  ///< the same for traces: how much the update slows tracing
};

/// A structure with one set of rays over the frames of a scene.
struct FrameSeries {
  std::string contender;  ///< with its parameters, except `update`
  std::string subject;    ///< scene and rays: `waving-sheet/default/640x480/1/primary`
  std::vector<FrameComparison> frames;  ///< ascending
};

/// The number of frames after which a structure should be rebuilt.
struct RebuildInterval {
  std::uint32_t frames;  ///< number of frames per build; all but one are updates
  double mean_ms;        ///< mean time of a frame at that interval
  bool is_all = false;   ///< no rebuild pays off within the frames measured
};

/// Returns the structures of a run that were measured both updated and rebuilt, in the order of the
/// run. Omits cells with wrong hits.
std::vector<FrameSeries> frame_series(const measure::Run& run);

/// Returns the interval with the least mean time per frame: a build, then an update in each
/// following frame. The k-th update after a build is assumed to cost as much as the measured update
/// to frame k. Interpolates linearly between measured frames.
RebuildInterval rebuild_interval(const FrameSeries& series);

}  // namespace beambench::analysis
