#include "harness/thesis/cluster/report.hpp"

#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/measure/record/machine.hpp"
#include "harness/thesis/cluster/image_division.hpp"
#include "harness/thesis/cluster/image_worker.hpp"

namespace beambench::cluster {
namespace {

using Json = nlohmann::ordered_json;

Json process_json(const ClusterRun& run, std::size_t process) {
  const ProcessReport& report = run.report.processes[process];
  const ReadyReport& ready_report = run.ready_reports[process];
  Json json{{"process", process},
            {"role", process == kProducer ? "producer" : "consumer"},
            {"host", ready_report.host},
            {"build_seconds", ready_report.build_seconds},
            {"structure_bytes", ready_report.structure_bytes},
            {"tasks", report.tasks},
            {"samples", report.samples},
            {"busy_seconds", report.busy_seconds},
            {"cpu_seconds", report.cpu_seconds},
            {"wait_seconds",
             process == kProducer ? run.report.producer_wait_seconds : report.wait_seconds},
            {"last_result_seconds", report.last_result}};
  if (process != kProducer) {
    json["from_producer"] = to_json(report.from_producer);
    json["to_producer"] = to_json(report.to_producer);
  }
  if (run.job.light && !report.counted.empty()) json["rays"] = to_json(read_census(report.counted));
  return json;
}

/// Returns the plural noun for the tasks of a run.
std::string_view tasks_of(const ClusterRun& run) {
  switch (work_named(run.work).value_or(Work::kBeams)) {
    case Work::kTiles:
      return "ranges of tiles";
    case Work::kContiguous:
    case Work::kInterlaced:
      return "rows";
    case Work::kBeams:
      return "beams";
    default:
      return "blocks";
  }
}

}  // namespace

nlohmann::ordered_json to_json(const render::RayCensus& census) {
  return {{"eye_hits", census.eye_hits},   {"reflected", census.reflected},
          {"refracted", census.refracted}, {"secondary_hits", census.secondary_hits},
          {"shadow", census.shadow},       {"shadow_hidden", census.shadow_hidden}};
}

Json to_json(const Traffic& traffic) {
  return {{"messages", traffic.messages}, {"bytes", traffic.bytes}};
}

Json to_json(const ClusterRun& run) {
  const measure::BuildInfo& build = measure::build_info();
  const ClusterReport& report = run.report;
  Json json{{"version", build.version},
            {"commit", build.commit},
            {"dirty", build.dirty},
            {"finished_utc", measure::utc_now()},
            {"scene", run.job.scene},
            {"structure", run.job.structure},
            {"width", run.job.resolution.width},
            {"height", run.job.resolution.height},
            {"samples", run.job.samples},
            {"results", run.job.light ? "light" : "hits"},
            {"work", run.work},
            {"batch", run.batch},
            {"in_flight", run.in_flight},
            {"producer_consumes", run.producer_consumes},
            {"result_hash", fmt::format("{:016x}", run.result_hash)},
            {"processes", report.processes.size()},
            {"tasks", report.tasks.size()},
            {"stored", run.stored},
            {"resumed_tasks", run.resumed_tasks},
            {"seconds", report.seconds},
            {"pre_pass_seconds", run.pre_pass_seconds},
            {"producer_busy_share", report.producer_busy_share()},
            {"walk_seconds", report.walk_seconds},
            {"accept_seconds", report.accept_seconds},
            {"from_producer", to_json(report.total(&ProcessReport::from_producer))},
            {"to_producer", to_json(report.total(&ProcessReport::to_producer))},
            {"remarks", report.remarks},
            {"lost", report.lost}};
  Json& processes = json["each"] = Json::array();
  for (std::size_t i = 0; i < report.processes.size(); ++i) {
    processes.push_back(process_json(run, i));
  }
  return json;
}

std::string task_table(const ClusterReport& report) {
  std::string table =
      "task,process,walk_seconds,work_seconds,accept_seconds,samples,task_bytes,result_bytes,"
      "estimate_seconds\n";
  for (std::size_t i = 0; i < report.tasks.size(); ++i) {
    const TaskReport& task = report.tasks[i];
    table += fmt::format("{},{},{:.9f},{:.9f},{:.9f},{},{},{},{:.9f}\n", i, task.process,
                         task.walk_seconds, task.work_seconds, task.accept_seconds, task.samples,
                         task.task_bytes, task.result_bytes, task.estimate_seconds);
  }
  table += fmt::format("end,0,{:.9f},0,0,0,0,0,0\n", report.last_walk_seconds);
  return table;
}

std::string summary(const ClusterRun& run) {
  const ClusterReport& report = run.report;
  const Traffic out = report.total(&ProcessReport::from_producer);
  const Traffic back = report.total(&ProcessReport::to_producer);
  return fmt::format(
      "{} {} on {} processes in {:.3f} s; the producer was busy {:.0f}% of that time; it sent {} "
      "messages with {:.2f} MB and received {} with {:.2f} MB",
      report.tasks.size(), tasks_of(run), report.processes.size(), report.seconds,
      100.0 * report.producer_busy_share(), out.messages, 1e-6 * static_cast<double>(out.bytes),
      back.messages, 1e-6 * static_cast<double>(back.bytes));
}

}  // namespace beambench::cluster
