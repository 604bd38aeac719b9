#include "harness/thesis/cluster/run.hpp"

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
#include "harness/rays/fingerprint.hpp"
#include "harness/rays/hit_check.hpp"
#include "harness/render/picture/image_file.hpp"
#include "harness/render/shading.hpp"
#include "harness/render/whitted.hpp"
#include "harness/thesis/cluster/consumer.hpp"
#include "harness/thesis/cluster/image_division.hpp"
#include "harness/thesis/cluster/image_worker.hpp"
#include "harness/thesis/cluster/planned_source.hpp"
#include "harness/thesis/cluster/split/split_run.hpp"
#include "harness/thesis/cluster/tasks.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/files.hpp"
#include "scenes/base/json_text.hpp"
#include "scenes/catalogue.hpp"

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

/// The objects that every process builds itself: the scene, its octree, the rays.
struct WorkerState {
  /// Loads and builds. Throws InputError if that fails or the structure is not `beam`. Appends the
  /// warnings of the scene's reader to `warnings` if given.
  explicit WorkerState(const Job& job, std::vector<std::string>* warnings = nullptr)
      : scene(scenes::load_scene(job.scene, warnings)),
        image(job_image(job, scene)),
        rays(image.rays()) {
    const accel::StructureChoice choice = beam_choice(job);
    const base::CpuStopwatch timer;
    tracer = accel::beam::build_beam_tracer(choice, scene, rays::workload_of(image, rays));
    build_seconds = timer.seconds();
    if (job.light) light.emplace(scene, *tracer, job.whitted, rays::HitCheck(scene, choice));
  }

  ReadyReport ready_report() const {
    const accel::octree::Octree& octree = tracer->octree();
    return {host_name(),
            "",
            {visible_hash(scene), scene.primitives.size(), octree.nodes().size(),
             octree.reference_count()},
            build_seconds,
            tracer->statistics().bytes};
  }
  /// Returns the key of this picture's results.
  std::string key(Job job) const {
    job.resolution = image.resolution;
    return picture_key(job, ready_report().identity);
  }
  ImageWorker worker() const { return {*tracer, rays, light ? &*light : nullptr}; }

  scenes::Scene scene;
  rays::ImageOfRays image;
  accel::PrimaryRays rays;
  std::unique_ptr<accel::beam::BeamTracer> tracer;
  std::optional<render::Whitted> light;  ///< nothing if the job needs only hits
  double build_seconds = 0.0;
};

/// The producer's tasks, and the time spent on estimates.
struct Plan {
  std::unique_ptr<TaskSource> source;
  double pre_pass_seconds = 0.0;
};

/// Returns the numbers of the unfinished tiles.
std::vector<std::size_t> tiles_left(const TileOrder& order, const TaskSet& finished) {
  std::vector<bool> done(order.count(), false);
  for (const Bytes& task : finished) {
    const auto tiles = read_tiles(task);
    for (std::size_t i = 0; tiles && i < tiles->count; ++i) done.at(tiles->first + i) = true;
  }
  std::vector<std::size_t> left;
  for (std::size_t i = 0; i < done.size(); ++i) {
    if (!done[i]) left.push_back(i);
  }
  return left;
}

/// Plans tiles by number, with one range of numbers in each message.
Plan plan_tiles(const ClusterRequest& request, const WorkerState& state, int consumers,
                const TaskSet& finished) {
  const TileOrder order(state.rays.width(), state.rays.height(), request.block_size);
  const ImageDivision division =
      request.batch_given ? ImageDivision::kBatches : ImageDivision::kFalling;
  const std::vector<std::size_t> left = tiles_left(order, finished);
  const std::vector<Share> shares =
      divide(division, left.size(), {consumers, request.producer.batch, {}});
  std::vector<Bytes> tasks;
  std::vector<Share> messages;
  for (const Share& share : shares) {
    Share& message = messages.emplace_back();
    // If some tiles are finished, the remaining tiles form several ranges.
    for (std::size_t i = 0; i < share.size();) {
      const std::size_t first = left[share[i]];
      std::size_t count = 1;
      while (i + count < share.size() && left[share[i] + count] == first + count) ++count;
      i += count;
      message.push_back(tasks.size());
      write_task(TileTask{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count),
                          static_cast<std::uint16_t>(request.block_size)},
                 tasks.emplace_back());
    }
  }
  return {std::make_unique<PlannedSource>(std::move(tasks), std::move(messages),
                                          std::vector<double>{})};
}

/// Returns the rows or blocks of a static division.
std::vector<accel::beam::PixelRect> parts_of(const ClusterRequest& request,
                                             const accel::PrimaryRays& rays) {
  if (request.work == Work::kContiguous || request.work == Work::kInterlaced) {
    return blocks_of(rays.width(), rays.height(), rays.width(), 1);
  }
  return blocks_of(rays.width(), rays.height(), request.block_size, request.block_size);
}

Plan plan_static(const ClusterRequest& request, const WorkerState& state, int consumers,
                 const TaskSet& finished) {
  const std::vector<accel::beam::PixelRect> parts = parts_of(request, state.rays);
  std::vector<Bytes> tasks(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) write_task(BlockTask{parts[i]}, tasks[i]);
  std::vector<double> estimates;
  const base::CpuStopwatch timer;
  if (request.work == Work::kPrePass) {
    ImageWorker worker = state.worker();
    estimates = estimate_costs(parts, worker);
  }
  const double seconds = timer.seconds();
  std::vector<Share> shares =
      divide(division_of(request.work), tasks.size(), {consumers, 1, estimates});
  for (Share& share : shares) {
    std::erase_if(share, [&](std::size_t task) { return finished.contains(tasks[task]); });
  }
  std::erase_if(shares, [](const Share& share) { return share.empty(); });
  return {std::make_unique<PlannedSource>(std::move(tasks), std::move(shares), estimates), seconds};
}

/// Plans the unfinished tasks.
Plan make_plan(const ClusterRequest& request, const WorkerState& state, int processes,
               const TaskSet& finished) {
  const accel::PrimaryRays& rays = state.rays;
  const int consumers = std::max(1, processes - 1);
  require_tasks(*state.tracer);
  const auto remaining = [&](std::unique_ptr<TaskSource> all) {
    if (finished.empty()) return Plan{std::move(all)};
    return Plan{std::make_unique<RemainingSource>(std::move(all), finished)};
  };
  switch (request.work) {
    case Work::kBeams:
      return remaining(std::make_unique<BeamSource>(*state.tracer, rays));
    case Work::kBlocks:
      return remaining(
          std::make_unique<BlockSource>(rays.width(), rays.height(), request.block_size));
    case Work::kTiles:
      return plan_tiles(request, state, consumers, finished);
    default:
      return plan_static(request, state, consumers, finished);
  }
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

/// The producer's part in keeping results. Reads the results of an interrupted run. Either keeps
/// results as they arrive or, at the end, collects the results that the processes kept themselves.
class Keeper {
 public:
  /// Passes existing results to the sink. Throws InputError if they belong to another picture. A
  /// failure to keep results is only a warning, unless all processes must do so.
  Keeper(const ClusterRequest& request, const std::string& key, ResultSink& sink,
         std::vector<std::string>& warnings)
      : options_(request.producer), folder_(request.kept), key_(key) {
    stored_ = !request.job.stored.empty();
    if (!folder_) return;
    folder_->read(key_, [&](std::span<const std::byte> task, std::span<const std::byte> result) {
      finished_.emplace(task.begin(), task.end());
      if (!stored_) sink.accept(result);
    });
    if (!finished_.empty()) {
      warnings.push_back(
          fmt::format("{} finished tasks of an interrupted run are used", finished_.size()));
    }
    try {
      file_.emplace(folder_->path(), kProducer, key_);
    } catch (const InputError& error) {
      if (stored_) throw;
      warnings.emplace_back(error.what());
    }
  }

  const TaskSet& finished() const { return finished_; }

  /// Does the producer's work; at the end, the sink has all results.
  ClusterReport produce(Transport& transport, TaskSource& source, ResultSink& sink,
                        ImageWorker& own, const Producer::Check& check) {
    if (!stored_) {
      if (file_) options_.keep = [this](auto task, auto result) { keep(task, result); };
      return Producer(transport, source, sink, own, check, options_).run();
    }
    StoringWorker storing(own, *file_);
    ReceiptSink receipts;
    ClusterReport report = Producer(transport, source, receipts, storing, check, options_).run();
    collect(finished_.size() + report.tasks.size(), sink);
    return report;
  }

 private:
  /// Keeps a result. After a failure, the run continues without keeping results: a picture that
  /// cannot be resumed is better than no picture.
  void keep(std::span<const std::byte> task, std::span<const std::byte> result) {
    if (!file_) return;
    try {
      file_->add(task, result);
    } catch (const InputError& error) {
      base::print_message(
          stderr, fmt::format("beambench-cluster: {}; the run continues, but cannot be resumed\n",
                              error.what()));
      file_.reset();
      folder_->remove();
    }
  }

  void collect(std::size_t tasks, ResultSink& sink) const {
    std::size_t found = 0;
    folder_->read(key_, [&](std::span<const std::byte>, std::span<const std::byte> result) {
      sink.accept(result);
      ++found;
    });
    if (found == tasks) return;
    throw InputError(
        fmt::format("{}: contains the results of {} of {} tasks; with --results stored, all "
                    "processes must see the same folder",
                    folder_->path().string(), found, tasks));
  }

  ProducerOptions options_;
  std::shared_ptr<KeptFolder> folder_;
  std::string key_;
  bool stored_ = false;
  TaskSet finished_;
  std::optional<KeptFile> file_;
};

void write_files(const ClusterRequest& request, const WorkerState& state, const Result& result,
                 const ClusterRun& run) {
  if (!request.picture.empty()) {
    render::write_image(request.picture, result.picture(state, request.shading));
  }
  if (!request.report.empty()) write_file(request.report, json_text(to_json(run)) + "\n");
  if (!request.tasks.empty()) write_file(request.tasks, task_table(run.report));
}

/// Returns the record of the run without its report.
ClusterRun describe(const ClusterRequest& request, const WorkerState& state, int processes) {
  ClusterRun run;
  run.job = request.job;
  run.job.resolution = state.image.resolution;
  run.work = name_of(request.work);
  run.stored = !request.job.stored.empty();
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
  std::optional<Result> result;
  std::optional<Keeper> keeper;
  Plan plan;
  set_up_producer(transport, [&](std::vector<std::string>& warnings) {
    state.emplace(request.job, &warnings);
    result.emplace(*state, request.job.light);
    keeper.emplace(request, state->key(request.job), result->sink(), warnings);
    plan = make_plan(request, *state, transport.processes(), keeper->finished());
  });
  ClusterRun run = describe(request, *state, transport.processes());
  run.pre_pass_seconds = plan.pre_pass_seconds;
  run.resumed_tasks = keeper->finished().size();
  const auto check = [&, mine = run.ready_reports[kProducer].identity,
                      missing = transport.processes() - 1](
                         ProcessId process, std::span<const std::byte> ready_report) mutable {
    run.ready_reports[static_cast<std::size_t>(process)] =
        read_ready_report(process, ready_report, mine);
    if (--missing == 0) {
      base::print_message(stderr, "beambench-cluster: all consumers are ready\n");
    }
  };
  ImageWorker worker = state->worker();
  run.report = keeper->produce(transport, *plan.source, result->sink(), worker, check);
  run.result_hash = result->hash();
  write_files(request, *state, *result, run);
  if (request.kept) request.kept->remove();
  return run;
}

void follow(Transport& transport) {
  Bytes bytes;
  transport.broadcast(bytes);
  if (bytes.empty()) return;
  const auto job = set_up_consumer(transport, [&] { return read_job(bytes); });
  if (!job) return;
  if (job->split_level > 0) return follow_split(*job, transport);
  std::optional<KeptFile> file;
  const auto state = set_up_consumer(transport, [&] {
    auto made = std::make_unique<WorkerState>(*job);
    if (!job->stored.empty()) file.emplace(job->stored, transport.self(), made->key(*job));
    return made;
  });
  if (!state) return;
  const Bytes ready_report = write_ready_report((*state)->ready_report());
  ImageWorker worker = (*state)->worker();
  if (!file) return consume(transport, worker, job->heartbeat_interval, ready_report);
  StoringWorker storing(worker, *file);
  consume(transport, storing, job->heartbeat_interval, ready_report);
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
