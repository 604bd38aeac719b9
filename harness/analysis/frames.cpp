#include "harness/analysis/frames.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "harness/analysis/standings.hpp"
#include "harness/measure/plan.hpp"
#include "harness/measure/record/block_statistics.hpp"
#include "harness/measure/record/robust_statistics.hpp"
#include "scenes/animation.hpp"

namespace beambench::analysis {
namespace {

using measure::CellRecord;
using measure::Repetition;

constexpr const char* kUpdated = "update=true";
constexpr const char* kBuilt = "update=false";

/// Returns a cell's parameters with one string replaced by another; nothing if the parameters do
/// not contain the first string.
std::optional<std::string> replaced(std::string parameters, const std::string& text,
                                    const std::string& by) {
  const std::size_t at = parameters.find(text);
  if (at == std::string::npos) return std::nullopt;
  return parameters.replace(at, text.size(), by);
}

std::optional<FrameCost> cost_of(const CellRecord& cell) {
  const auto trace = trace_time(cell);
  if (!trace || cell.repetitions.empty()) return std::nullopt;
  return FrameCost{measure::median(measure::collect(cell, &Repetition::ready_ms)), trace->value,
                   cell.statistics ? cell.statistics->figure("sah_cost") : std::nullopt};
}

std::optional<TimeRatio> ratio_of(const CellRecord& over, const CellRecord& under,
                                  TimesByBlock (*times)(const CellRecord&, measure::TraceClock)) {
  const measure::TraceClock clock = measure::is_disturbed(over) || measure::is_disturbed(under)
                                        ? measure::TraceClock::kCpu
                                        : measure::TraceClock::kWall;
  return block_ratio(times(over, clock), times(under, clock));
}

std::string subject_of(const measure::CellId& id) {
  return fmt::format("{}/{}/{}/{}/{}",
                     measure::shown_scene(std::string(scenes::divide_frame(id.scene).scene)),
                     id.camera, rays::to_string(id.resolution), id.samples, id.rays);
}

}  // namespace

std::vector<FrameSeries> frame_series(const measure::Run& run) {
  std::map<std::string, const CellRecord*> by_name;
  for (const CellRecord& cell : run.cells) by_name[cell.id.name()] = &cell;
  std::vector<FrameSeries> all;
  for (const CellRecord& cell : run.cells) {
    const auto frame = scenes::divide_frame(cell.id.scene).frame;
    const auto parameters = replaced(cell.id.parameters, kUpdated, kBuilt);
    if (!frame || !parameters) continue;
    measure::CellId twin = cell.id;
    twin.parameters = *parameters;
    const auto found = by_name.find(twin.name());
    if (found == by_name.end()) continue;
    const auto updated = cost_of(cell), built = cost_of(*found->second);
    const auto total = ratio_of(cell, *found->second, measure::total_by_block);
    const auto trace = ratio_of(cell, *found->second, measure::trace_by_block);
    if (!updated || !built || !total || !trace) continue;
    const std::string contender = measure::shown_structure(twin), subject = subject_of(cell.id);
    auto series = std::ranges::find_if(all, [&](const FrameSeries& one) {
      return one.contender == contender && one.subject == subject;
    });
    if (series == all.end()) series = all.insert(all.end(), {contender, subject, {}});
    series->frames.push_back({*frame, *updated, *built, *total, *trace});
  }
  for (FrameSeries& one : all) std::ranges::sort(one.frames, {}, &FrameComparison::frame);
  return all;
}

RebuildInterval rebuild_interval(const FrameSeries& series) {
  const auto& frames = series.frames;
  const std::uint32_t last = frames.back().frame;
  const auto updated_ms = [&](std::uint32_t frame) {
    const auto next = std::ranges::lower_bound(frames, frame, {}, &FrameComparison::frame);
    if (next == frames.begin() || next->frame == frame) return next->updated.total_ms();
    const auto before = next - 1;
    const double part = static_cast<double>(frame - before->frame) /
                        static_cast<double>(next->frame - before->frame);
    return (1.0 - part) * before->updated.total_ms() + part * next->updated.total_ms();
  };
  double sum = frames.front().built.total_ms();
  RebuildInterval best{1, sum};
  for (std::uint32_t frame = 1; frame <= last; ++frame) {
    sum += updated_ms(frame);
    const double mean = sum / (frame + 1.0);
    if (mean < best.mean_ms) best = {frame + 1, mean};
  }
  best.is_all = best.frames == last + 1;
  return best;
}

}  // namespace beambench::analysis
