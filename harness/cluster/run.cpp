#include "harness/cluster/run.hpp"

#include <cstdio>
#include <memory>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "harness/cluster/consumer.hpp"
#include "harness/cluster/image_worker.hpp"
#include "harness/cluster/sample_results.hpp"
#include "harness/cluster/split/split_run.hpp"
#include "harness/cluster/tasks.hpp"
#include "harness/cluster/worker_state.hpp"
#include "harness/rays/fingerprint.hpp"
#include "harness/rays/hit_check.hpp"
#include "harness/render/picture/image_file.hpp"
#include "harness/render/shading.hpp"
#include "scenes/core/error.hpp"
#include "scenes/core/files.hpp"

namespace beambench::cluster {
namespace {

void shut_down_all(Transport& transport) {
  for (ProcessId process = kProducer + 1; process < transport.processes(); ++process) {
    transport.send(process, Tag::kEnd, {});
  }
  transport.flush();
}

void wait_for_end(Transport& transport) {
  while (true) {
    const auto message = transport.wait(Transport::kForever);
    if (message && message->tag == Tag::kEnd) return;
  }
}

std::unique_ptr<TaskSource> make_source(const ClusterRequest& request, const WorkerState& state) {
  const accel::PrimaryRays& rays = state.rays();
  if (request.blocks) {
    return std::make_unique<BlockSource>(rays.width(), rays.height(), request.block_size);
  }
  return std::make_unique<BeamSource>(state.tracer(), rays);
}

/// Collects the results.
class Result {
 public:
  Result(const WorkerState& state, bool light)
      : hits_(light ? 1 : state.rays().width(), light ? 1 : state.rays().height(),
              light ? 1 : state.rays().samples()),
        hit_sink_(hits_) {
    if (!light) return;
    const accel::PrimaryRays& rays = state.rays();
    color_sink_.emplace(rays.width(), rays.height(), rays.samples(),
                        glm::dvec3(render::background_color(state.scene())));
  }

  ResultSink& sink() {
    if (color_sink_) return *color_sink_;
    return hit_sink_;
  }

  render::Image picture(const WorkerState& state, render::Shading shading) const {
    if (color_sink_) return color_sink_->image();
    rays::HitCheck(state.scene(), "structure 'beam'").require(hits_, state.rays());
    return render::shade(state.scene(), state.rays(), hits_, shading);
  }

  std::uint64_t hash() const {
    if (!color_sink_) return rays::fingerprint(hits_);
    const render::Image image = color_sink_->image();
    const std::size_t pixels =
        static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height());
    return rays::fingerprint(std::string_view(reinterpret_cast<const char*>(&image.at(0, 0)),
                                              pixels * sizeof(glm::vec3)));
  }

 private:
  accel::HitBuffer hits_;
  HitSink hit_sink_;
  std::optional<ColorSink> color_sink_;
};

void write_files(const ClusterRequest& request, const WorkerState& state, const Result& result,
                 const ClusterRun& run) {
  if (!request.picture.empty()) {
    render::write_image(request.picture, result.picture(state, request.shading));
  }
  if (!request.report.empty()) write_file(request.report, to_json(run).dump(2) + "\n");
  if (!request.tasks.empty()) write_file(request.tasks, task_table(run.report));
}

/// The run without its report.
ClusterRun describe(const ClusterRequest& request, const WorkerState& state, int processes) {
  ClusterRun run;
  run.job = request.job;
  run.job.width = state.rays().width();
  run.job.height = state.rays().height();
  run.work = request.blocks ? "blocks" : "beams";
  run.batch = request.producer.batch;
  run.in_flight = request.producer.in_flight;
  run.producer_consumes = request.producer.consumes;
  run.ready_reports.resize(static_cast<std::size_t>(processes));
  run.ready_reports[kProducer] = state.ready_report();
  return run;
}

}  // namespace

ClusterRun lead(const ClusterRequest& request, Transport& transport) {
  std::optional<WorkerState> state;
  std::unique_ptr<TaskSource> source;
  set_up_producer(transport, [&](std::vector<std::string>& warnings) {
    state.emplace(request.job, &warnings);
    source = make_source(request, *state);
  });
  ClusterRun run = describe(request, *state, transport.processes());
  const auto check = [&, mine = state->identity()](ProcessId process,
                                                   std::span<const std::byte> ready_report) {
    run.ready_reports[static_cast<std::size_t>(process)] =
        read_ready_report(process, ready_report, mine);
  };
  Result result(*state, request.job.light);
  ImageWorker own(state->tracer(), state->rays(), state->light());
  run.report = Producer(transport, *source, result.sink(), own, check, request.producer).run();
  run.result_hash = result.hash();
  write_files(request, *state, result, run);
  return run;
}

void follow(Transport& transport) {
  Bytes bytes;
  transport.broadcast(bytes);
  if (bytes.empty()) return;
  const auto job = set_up_consumer(transport, [&] { return read_job(bytes); });
  if (!job) return;
  if (job->split_level > 0) return follow_split(*job, transport);
  const auto state =
      set_up_consumer(transport, [&] { return std::make_unique<WorkerState>(*job); });
  if (!state) return;
  const WorkerState& built = **state;
  ImageWorker worker(built.tracer(), built.rays(), built.light());
  Consumer(transport, worker, job->heartbeat_interval)
      .run(write_ready_report(built.ready_report()));
}

void set_up_producer(Transport& transport,
                     const std::function<void(std::vector<std::string>& warnings)>& set_up) {
  std::vector<std::string> warnings;
  try {
    set_up(warnings);
  } catch (...) {
    shut_down_all(transport);
    throw;
  }
  for (const std::string& warning : warnings) {
    fmt::print(stderr, "beambench-cluster: {}\n", warning);
  }
}

void report_setup_failure(Transport& transport, const std::string& problem) {
  ReadyReport ready_report;
  ready_report.host = host_name();
  ready_report.problem = problem;
  transport.send(kProducer, Tag::kReady, write_ready_report(ready_report));
  wait_for_end(transport);
}

}  // namespace beambench::cluster
