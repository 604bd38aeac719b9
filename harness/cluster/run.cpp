#include "harness/cluster/run.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "accel/beam/beam_tracer.hpp"
#include "accel/core/registry.hpp"
#include "harness/base/messages.hpp"
#include "harness/base/stopwatch.hpp"
#include "harness/cluster/consumer.hpp"
#include "harness/cluster/division.hpp"
#include "harness/cluster/image_worker.hpp"
#include "harness/cluster/planned_source.hpp"
#include "harness/cluster/split/split_run.hpp"
#include "harness/cluster/tasks.hpp"
#include "harness/rays/fingerprint.hpp"
#include "harness/rays/hit_check.hpp"
#include "harness/render/picture/image_file.hpp"
#include "harness/render/shading.hpp"
#include "harness/render/whitted.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/core/error.hpp"
#include "scenes/core/files.hpp"
#include "scenes/core/json_text.hpp"

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

/// What every process builds for itself: the scene, its octree, the rays.
struct WorkerState {
  /// Loads and builds. Throws InputError if that fails or the structure is not `beam`. Warnings of
  /// the scene's reader are appended to `warnings` if given.
  explicit WorkerState(const Job& job, std::vector<std::string>* warnings = nullptr)
      : scene(scenes::load_scene(job.scene, warnings)),
        image(job_image(job, scene)),
        rays(image.rays()) {
    const accel::StructureChoice choice = beam_choice(job);
    const base::CpuStopwatch timer;
    structure = choice.build(scene, rays::workload_of(image, rays));
    build_seconds = timer.seconds();
    tracer = &dynamic_cast<const accel::beam::BeamTracer&>(*structure);
    if (job.light) light.emplace(scene, *structure, job.whitted, rays::HitCheck(scene, choice));
  }

  ReadyReport ready_report() const {
    const accel::octree::Octree& octree = tracer->octree();
    return {host_name(),
            "",
            {visible_hash(scene), scene.primitives.size(), octree.nodes().size(),
             octree.reference_count()},
            build_seconds,
            structure->statistics().bytes};
  }
  ImageWorker worker() const { return {*tracer, rays, light ? &*light : nullptr}; }

  scenes::Scene scene;
  rays::ImageOfRays image;
  accel::PrimaryRays rays;
  std::unique_ptr<accel::Accelerator> structure;
  const accel::beam::BeamTracer* tracer = nullptr;
  std::optional<render::Whitted> light;  ///< nothing if the job is for hits alone
  double build_seconds = 0.0;
};

/// The image's parts of a work that is divided before, in their order.
std::vector<accel::beam::PixelRect> parts_of(const ClusterRequest& request,
                                             const accel::PrimaryRays& rays) {
  const int size = request.block_size;
  switch (request.work) {
    case Work::kContiguous:
    case Work::kInterlaced:
      return blocks_of(rays.width(), rays.height(), rays.width(), 1);
    case Work::kTiles:
      return spread(blocks_of(rays.width(), rays.height(), size, size));
    default:
      return blocks_of(rays.width(), rays.height(), size, size);
  }
}

/// The producer's tasks, and what it took to estimate them.
struct Plan {
  std::unique_ptr<TaskSource> source;
  double pre_pass_seconds = 0.0;
};

/// For that many consumers.
Plan make_plan(const ClusterRequest& request, const WorkerState& state, int consumers) {
  const accel::PrimaryRays& rays = state.rays;
  if (request.work == Work::kBeams) {
    return {std::make_unique<BeamSource>(*state.tracer, rays)};
  }
  if (request.work == Work::kBlocks) {
    return {std::make_unique<BlockSource>(rays.width(), rays.height(), request.block_size)};
  }
  require_tasks(*state.tracer);
  const std::vector<accel::beam::PixelRect> parts = parts_of(request, rays);
  std::vector<Bytes> tasks(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (request.work == Work::kTiles) {
      write_task(TileTask{parts[i]}, tasks[i]);
    } else {
      write_task(BlockTask{parts[i]}, tasks[i]);
    }
  }
  std::vector<double> estimates;
  const base::CpuStopwatch timer;
  if (request.work == Work::kPrePass) {
    ImageWorker worker = state.worker();
    estimates = estimate_costs(parts, worker);
  }
  const double seconds = timer.seconds();
  std::vector<Share> shares =
      divide(division_of(request.work), tasks.size(), std::max(1, consumers), estimates);
  return {std::make_unique<PlannedSource>(std::move(tasks), std::move(shares), estimates), seconds};
}

/// Collects the results.
class Result {
 public:
  Result(const WorkerState& state, bool light)
      : hits_(light ? 1 : state.rays.width(), light ? 1 : state.rays.height(),
              light ? 1 : state.rays.samples()),
        hit_sink_(hits_) {
    if (!light) return;
    color_sink_.emplace(state.rays.width(), state.rays.height(), state.rays.samples(),
                        glm::dvec3(render::background_color(state.scene)));
  }

  ResultSink& sink() {
    if (color_sink_) return *color_sink_;
    return hit_sink_;
  }

  render::Image picture(const WorkerState& state, render::Shading shading) const {
    if (color_sink_) return color_sink_->image();
    rays::HitCheck(state.scene, "structure 'beam'").require(hits_, state.rays);
    return render::shade(state.scene, state.rays, hits_, shading);
  }

  std::uint64_t hash() const {
    return color_sink_ ? render::fingerprint(color_sink_->image()) : rays::fingerprint(hits_);
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
  if (!request.report.empty()) write_file(request.report, json_text(to_json(run)) + "\n");
  if (!request.tasks.empty()) write_file(request.tasks, task_table(run.report));
}

/// The run without its report.
ClusterRun describe(const ClusterRequest& request, const WorkerState& state, int processes) {
  ClusterRun run;
  run.job = request.job;
  run.job.resolution = state.image.resolution;
  run.work = name_of(request.work);
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
  Plan plan;
  set_up_producer(transport, [&](std::vector<std::string>& warnings) {
    state.emplace(request.job, &warnings);
    plan = make_plan(request, *state, transport.processes() - 1);
  });
  ClusterRun run = describe(request, *state, transport.processes());
  run.pre_pass_seconds = plan.pre_pass_seconds;
  const auto check = [&, mine = run.ready_reports[kProducer].identity,
                      missing = transport.processes() - 1](
                         ProcessId process, std::span<const std::byte> ready_report) mutable {
    run.ready_reports[static_cast<std::size_t>(process)] =
        read_ready_report(process, ready_report, mine);
    if (--missing == 0) {
      base::print_message(stderr, "beambench-cluster: all consumers are ready\n");
    }
  };
  Result result(*state, request.job.light);
  ImageWorker own = state->worker();
  run.report = Producer(transport, *plan.source, result.sink(), own, check, request.producer).run();
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
  ImageWorker worker = (*state)->worker();
  consume(transport, worker, job->heartbeat_interval, write_ready_report((*state)->ready_report()));
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
    base::print_message(stderr, fmt::format("beambench-cluster: {}\n", warning));
  }
}

void report_setup_failure(Transport& transport, const std::string& problem) {
  transport.send(kProducer, Tag::kReady, write_ready_report({host_name(), problem, {}, 0.0, 0}));
  wait_for_end(transport);
}

}  // namespace beambench::cluster
