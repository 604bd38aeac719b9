#include "harness/measure/tuning.hpp"

#include <algorithm>
#include <exception>
#include <memory>
#include <utility>

#include <glm/gtc/matrix_transform.hpp>

#include "harness/measure/measurement.hpp"
#include "harness/measure/task.hpp"
#include "scenes/base/error.hpp"

namespace beambench::measure {
namespace {

using Json = nlohmann::ordered_json;

/// Returns the time of the fastest of a few traces of a candidate, in milliseconds.
double time_candidate(const PlannedCell& cell, Task& task, int traces) {
  task.require_support(cell.structure);
  const MeasuringFloatMode mode;
  const auto structure = cell.structure.build(task.scene(), task.workload());
  return least_ms(traces, [&] { task.trace(*structure); });
}

}  // namespace

std::vector<accel::StructureChoice> best_embree(const accel::Registry& structures) {
  const auto info =
      std::ranges::find(structures.structures(), "embree", &accel::StructureInfo::name);
  if (info == structures.structures().end())
    throw InputError("this program was built without Embree");
  std::vector<accel::StructureChoice> sets;
  const auto add = [&](const std::string& mode, const char* coherent) {
    sets.push_back(structures.choose(
        {"embree", {{"mode", mode}, {"robust", "false"}, {"coherent", coherent}}}));
  };
  for (const std::string& mode :
       std::ranges::find(info->parameters, "mode", &ParameterInfo::name)->choices) {
    if (mode == "single" || mode == "packet4") {
      add(mode, "auto");
    } else {
      for (const char* coherent : {"true", "false"}) add(mode, coherent);
    }
  }
  return sets;
}

scenes::Camera tuning_camera(const scenes::Camera& camera) {
  constexpr float kShare = 0.25F;
  scenes::Camera turned = camera;
  const float angle = glm::radians(kShare * camera.angle);
  const glm::mat3 turn(glm::rotate(glm::mat4(1.0F), angle, camera.up));
  turned.at = camera.from + turn * (camera.at - camera.from);
  return turned;
}

void time_candidates(const Block& block, const BlockWatch& watch) {
  constexpr int kTraces = 3;
  CellGroup view = block.view;
  view.camera = tuning_camera(view.camera);
  const PinnedThread pin(block.core);
  std::map<bool, std::unique_ptr<Task>> tasks;  // key: whether the rays are sorted
  for (const BlockCell& each : block.cells) {
    watch.before_each_piece(each.cell.index);
    Json event{{"event", "candidate"}, {"index", each.cell.index}};
    try {
      std::unique_ptr<Task>& task = tasks[each.cell.rays.is_sorted];
      if (!task) task = make_task(view, each.cell.rays, block.core, std::nullopt);
      event["trace_ms"] = time_candidate(each.cell, *task, kTraces);
    } catch (const std::exception& error) {
      event["error"] = error.what();
    }
    watch.sink(event);
  }
}

std::vector<std::size_t> fastest(const std::map<std::size_t, double>& times,
                                 const std::vector<std::size_t>& all) {
  std::vector<std::pair<double, std::size_t>> order;
  for (const auto& [index, ms] : times) order.emplace_back(ms, index);
  std::ranges::sort(order);
  std::vector<std::size_t> kept;
  for (const auto& [ms, index] : order) {
    if (kept.size() < kMeasuredSets) kept.push_back(index);
  }
  return kept.empty() ? all : kept;
}

}  // namespace beambench::measure
