// Moving scenes: what an update saves in each frame, and how often a rebuild pays off.

#include "harness/analysis/frames.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/analysis/analysis.hpp"
#include "harness/analysis/words.hpp"
#include "tests/analysis/some_run.hpp"

namespace beambench::analysis {
namespace {

using measure::CellRecord;

/// Returns a cell of a frame: rebuilt in 10 ms or updated in 2 ms.
CellRecord cell_in(int frame, bool updated, double trace_ms) {
  CellRecord cell = cell_of({.structure = "sah-bvh",
                             .trace_ms = std::vector<double>(6, trace_ms),
                             .build_ms = 10.0,
                             .parameters = updated ? "update=true" : "update=false"},
                            "waving-sheet@" + std::to_string(frame));
  for (measure::Repetition& one : cell.repetitions) {
    if (updated) one.update_ms = one.update_cpu_ms = 2.0;
  }
  return cell;
}

/// Returns a run in which the trace after an update takes 5 ms plus `slower` per frame.
measure::Run run_with(const std::vector<int>& frames, double slower) {
  std::vector<CellRecord> cells;
  for (const int frame : frames) {
    cells.push_back(cell_in(frame, false, 5.0));
    cells.push_back(cell_in(frame, true, 5.0 + slower * frame));
  }
  return run_of(cells);
}

TEST(Frames, BothWaysAreComparedInEachFrame) {
  const auto all = frame_series(run_with({0, 10}, 0.5));
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].subject, "waving-sheet/default/100x10/1/primary");
  ASSERT_EQ(all[0].frames.size(), 2U);
  const FrameComparison& last = all[0].frames[1];
  EXPECT_EQ(last.frame, 10U);
  EXPECT_DOUBLE_EQ(last.updated.ready_ms, 2.0);
  EXPECT_DOUBLE_EQ(last.built.ready_ms, 10.0);
  EXPECT_NEAR(last.trace.value, 10.0 / 5.0, 1e-12);
  EXPECT_NEAR(last.total.value, 12.0 / 15.0, 1e-12);
  EXPECT_TRUE(last.total.is_paired);
}

TEST(Frames, WithoutLossUpdatesPayOffInAllFrames) {
  const RebuildInterval interval = rebuild_interval(frame_series(run_with({0, 10}, 0.0))[0]);
  EXPECT_TRUE(interval.is_all);
  EXPECT_EQ(interval.frames, 11U);
  EXPECT_NEAR(interval.mean_ms, (15.0 + 10 * 7.0) / 11.0, 1e-12);
}

TEST(Frames, ARebuildPaysOffAfterSomeFrames) {
  // A frame costs 15 ms after a build, and 7 ms plus 2 ms per frame since then after an update. The
  // mean over 1, 2, 3 and 4 frames is 15, 24/2, 35/3 and 48/4 ms.
  const RebuildInterval interval = rebuild_interval(frame_series(run_with({0, 5, 10}, 2.0))[0]);
  EXPECT_FALSE(interval.is_all);
  EXPECT_EQ(interval.frames, 3U);
  EXPECT_NEAR(interval.mean_ms, 35.0 / 3.0, 1e-12);
}

TEST(Frames, UpdatesThatCostMoreThanBuildsNeverPayOff) {
  const RebuildInterval interval = rebuild_interval(frame_series(run_with({0, 1}, 20.0))[0]);
  EXPECT_EQ(interval.frames, 1U);
}

TEST(Frames, AStructureThatWasMeasuredOneWayIsNoSeries) {
  EXPECT_TRUE(frame_series(run_of({cell_in(0, true, 1.0), cell_in(3, true, 1.0)})).empty());
  CellRecord still = cell_in(0, true, 1.0);
  still.id.scene = "waving-sheet";
  EXPECT_TRUE(frame_series(run_of({still})).empty());
}

TEST(Frames, AreDescribedAndExported) {
  const Analysis analysis = analyze(run_with({0, 10}, 0.0));
  EXPECT_NE(summary(analysis).find("updates pay off in all frames measured"), std::string::npos);
  const auto json = to_json(analysis).at("frame_series").at(0);
  EXPECT_TRUE(json.at("rebuild_after").is_null());
  EXPECT_EQ(json.at("frames").size(), 2U);
}

}  // namespace
}  // namespace beambench::analysis
