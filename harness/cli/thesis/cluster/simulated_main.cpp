// beambench-cluster-simulated: computes the time of a picture on a simulated cluster.

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/base/messages.hpp"
#include "harness/base/process_start.hpp"
#include "harness/cli/inputs.hpp"
#include "harness/cli/thesis/cluster/division_option.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/thesis/cluster/simulation/simulate.hpp"
#include "harness/thesis/cluster/split/scene_division.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/json_text.hpp"

namespace beambench::cli {
namespace {

using namespace cluster;
using Json = nlohmann::ordered_json;

constexpr const char* kProgram = "beambench-cluster-simulated";
const CLI::Range kPositive(1e-12, 1e12);
const CLI::Range kNotNegative(0.0, 1e12);

struct ClusterOptions {
  ClusterModel model;
  std::string network = "switched";
  std::vector<double> speeds;
};

void add_cluster_options(CLI::App& app, ClusterOptions& cluster) {
  app.add_option("--network", cluster.network,
                 "shared: one medium; switched: a line in each direction for each machine")
      ->capture_default_str()
      ->check(CLI::IsMember({"shared", "switched"}));
  ClusterModel& model = cluster.model;
  app.add_option("--bandwidth", model.bytes_per_second,
                 "Bytes per second of the medium or of each line")
      ->capture_default_str()
      ->check(kPositive);
  app.add_option("--latency", model.latency_seconds, "Seconds between two machines")
      ->capture_default_str()
      ->check(kNotNegative);
  app.add_option("--message-seconds", model.message_cost.message_seconds,
                 "CPU seconds per message, of the sender and of the receiver")
      ->capture_default_str()
      ->check(kNotNegative);
  app.add_option("--byte-seconds", model.message_cost.byte_seconds,
                 "CPU seconds per byte, of the sender and of the receiver")
      ->capture_default_str()
      ->check(kNotNegative);
  app.add_option("--look-seconds", model.message_cost.look_seconds,
                 "CPU seconds to poll when there is no message")
      ->capture_default_str()
      ->check(kPositive);
  app.add_option("--speeds", cluster.speeds,
                 "Speeds of all machines except the first, repeated: 1,0.5")
      ->delimiter(',')
      ->check(kPositive);
  app.add_option("--loaded", model.loaded, "Number of machines that others also use at times");
  app.add_option("--loaded-share", model.loaded_share, "Share of their speed that others leave")
      ->capture_default_str()
      ->check(CLI::Range(1e-3, 1.0));
  app.add_option("--load-period", model.load_period,
                 "Seconds; others use the machines in the second half of each period")
      ->capture_default_str()
      ->check(kPositive);
}

/// Makes a cluster with a machine of speed 1 for process 0; repeats the given speeds for the
/// others.
ClusterModel cluster_of(const ClusterOptions& cluster, int processes) {
  ClusterModel model = cluster.model;
  model.network = cluster.network == "shared" ? ClusterModel::Network::kShared
                                              : ClusterModel::Network::kSwitched;
  model.speeds.assign(1, 1.0);
  for (int i = 1; i < processes; ++i) {
    const std::size_t given = cluster.speeds.size();
    model.speeds.push_back(given == 0 ? 1.0
                                      : cluster.speeds[static_cast<std::size_t>(i - 1) % given]);
  }
  return model;
}

struct ReplayRequest {
  std::string tasks;
  int consumers = 14;
  double walk_scale = 1.0;
  double work_scale = 1.0;
  double bytes_per_sample = 0.0;
  std::string division;
  ClusterOptions cluster;
  Replay replay;
};

const std::map<std::string, ImageDivision> kDivisions{{"contiguous", ImageDivision::kContiguous},
                                                      {"interlaced", ImageDivision::kInterlaced},
                                                      {"equal-cost", ImageDivision::kEqualCost},
                                                      {"falling", ImageDivision::kFalling}};

Json process_json(std::size_t number, const ProcessReport& process) {
  return {{"process", number},
          {"role", number == 0 ? "producer" : "consumer"},
          {"tasks", process.tasks},
          {"samples", process.samples},
          {"busy_seconds", process.busy_seconds},
          {"wait_seconds", process.wait_seconds},
          {"last_seconds", process.last_result}};
}

Json to_json(const Replay& replay, const SimulatedRun& run) {
  const TaskCosts& costs = replay.costs;
  const double build_seconds = replay.build_seconds;
  Json processes = Json::array();
  const Traffic down = run.report.total(&ProcessReport::from_producer);
  const Traffic up = run.report.total(&ProcessReport::to_producer);
  for (std::size_t i = 0; i < run.report.processes.size(); ++i) {
    processes.push_back(process_json(i, run.report.processes[i]));
  }
  return {{"tasks", costs.tasks.size()},
          {"seconds", run.seconds},
          {"traced_seconds", run.report.seconds},
          {"build_seconds", build_seconds},
          {"walk_seconds", costs.walk_seconds()},
          {"work_seconds", costs.work_seconds()},
          {"accept_seconds", costs.accept_seconds()},
          {"sequential_seconds", build_seconds + costs.walk_seconds() + costs.work_seconds()},
          {"producer_busy", run.report.producer_busy_share()},
          {"messages_from_producer", down.messages},
          {"bytes_from_producer", down.bytes},
          {"messages_to_producer", up.messages},
          {"bytes_to_producer", up.bytes},
          {"processes", processes}};
}

void run_replay(const ReplayRequest& request, const char* program) {
  Replay replay = request.replay;
  TaskCosts& costs = replay.costs;
  costs = slowed(read_task_costs(request.tasks), request.walk_scale, request.work_scale);
  replay.pre_pass_seconds *= request.work_scale;
  if (!request.division.empty()) replay.division = kDivisions.at(request.division);
  if (request.bytes_per_sample > 0.0) {
    costs = with_results_of(request.bytes_per_sample, std::move(costs));
  }
  const SimulatedRun result =
      simulate(cluster_of(request.cluster, request.consumers + 1), replay, program);
  fmt::print("{}\n", json_text(to_json(replay, result), 1));
}

void add_replay_options(CLI::App& app, ReplayRequest& request) {
  app.add_option("TASKS", request.tasks, "Recording of 'beambench-cluster SCENE --tasks FILE.csv'")
      ->required();
  app.add_option("--consumers", request.consumers, "Number of consumers")
      ->capture_default_str()
      ->check(CLI::Range(0, 4095));
  app.add_option("--walk-scale", request.walk_scale,
                 "Time to trace beams on a machine of speed 1, relative to the recorded time")
      ->check(kPositive);
  app.add_option("--work-scale", request.work_scale,
                 "Time for all other work on a machine of speed 1, relative to the recorded time")
      ->check(kPositive);
  app.add_option("--build-seconds", request.replay.build_seconds,
                 "Time of every process to read the scene and build the octree")
      ->check(kNotNegative);
  app.add_option("--sample-bytes", request.bytes_per_sample,
                 "Bytes of a result per sample (default: as recorded)")
      ->check(kPositive);
  app.add_option(
         "--division", request.division,
         "Messages planned in advance: contiguous, interlaced or equal-cost, one for each "
         "consumer; falling, with decreasing numbers of tasks (default: --batch tasks each)")
      ->check(CLI::IsMember(kDivisions));
  app.add_flag("--stored", request.replay.stored,
               "Results were recorded with --results stored: one receipt for a falling message");
  app.add_option("--pre-pass-seconds", request.replay.pre_pass_seconds,
                 "Producer's recorded time for estimating costs, before the first task")
      ->check(kNotNegative);
  add_cluster_options(app, request.cluster);
  app.add_option("--batch", request.replay.options.batch, "Tasks per message")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000));
  app.add_option("--in-flight", request.replay.options.in_flight,
                 "Messages that a consumer may hold")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  app.add_flag("--producer-consumes", request.replay.options.consumes,
               "The producer performs tasks while no consumer waits");
}

struct SplitRequest {
  Job job;
  ImageRequest image;
  std::string division = "primitives";
  int processes = 8;
  TimeScale scale;
  ClusterOptions cluster;
};

Json to_json(const SplitProcess& process) {
  const PartReport& report = process.report;
  return {{"primitives", report.primitives},
          {"bytes", report.scene_bytes + report.structure_bytes},
          {"beams_out", report.beams_out},
          {"rays_out", report.rays_out},
          {"messages_out", report.crossings_out.messages},
          {"bytes_out", report.crossings_out.bytes},
          {"build_seconds", process.build_seconds},
          {"walk_seconds", process.walk_seconds},
          {"test_seconds", process.test_seconds},
          {"take_seconds", process.take_seconds},
          {"busy", process.busy}};
}

Json to_json(const scenes::Scene& whole, const SimulatedSplit& run) {
  Json processes = Json::array();
  for (const SplitProcess& each : run.processes) processes.push_back(to_json(each));
  return {{"primitives", whole.primitives.size()},
          {"scene_bytes", scenes::memory_bytes(whole)},
          {"seconds", run.seconds},
          {"traced_seconds", run.traced_seconds},
          {"result_hash", fmt::format("{:016x}", run.result_hash)},
          {"processes", processes}};
}

void trace_split(const SplitRequest& request, const char* program) {
  const auto whole = std::make_shared<const scenes::Scene>(open_scene(request.job.scene));
  Job job = request.job;
  job.division = parse_scene_division(request.division);
  job.resolution = chosen_resolution(request.image).value_or(job.resolution);
  job.camera = request.image.view.camera;
  job.samples = request.image.samples;
  const SimulatedSplit result = simulate_split(cluster_of(request.cluster, request.processes), job,
                                               whole, request.scale, program);
  fmt::print("{}\n", json_text(to_json(*whole, result), 1));
}

void add_split_options(CLI::App& app, SplitRequest& request) {
  add_scene_option(app, request.job.scene);
  app.add_option("--accel", request.job.structure, "beam, with parameters: beam:max_level=6,...")
      ->capture_default_str();
  add_size_options(app, request.image);
  add_camera_option(app, request.image.view);
  app.add_option("--split", request.job.split_level,
                 "Level of the octree's cells that are distributed")
      ->capture_default_str()
      ->check(CLI::Range(2, 7));
  add_division_option(app, request.division);
  app.add_option("--processes", request.processes, "Number of parts")
      ->capture_default_str()
      ->check(CLI::Range(1, 1024));
  app.add_option(
         "--build-scale", request.scale.build,
         "Time on a machine of speed 1, relative to this machine, to divide the scene and to build")
      ->check(kPositive);
  app.add_option("--walk-scale", request.scale.walk, "The same for tracing beams")
      ->check(kPositive);
  app.add_option("--work-scale", request.scale.work, "The same for all other work")
      ->check(kPositive);
  add_cluster_options(app, request.cluster);
}

/// Adds a missing subcommand: `split` for the name `beambench-split-simulated`, otherwise
/// `cluster`. Both are supported for one more version.
std::vector<std::string> with_subcommand(int argc, char** argv) {
  std::vector<std::string> arguments(argv + 1, argv + argc);
  const std::string program = std::filesystem::path(argv[0]).filename();
  const std::string first = arguments.empty() ? "" : arguments.front();
  std::string subcommand;
  if (program == "beambench-split-simulated") {
    if (first != "split") subcommand = "split";
  } else if (!first.empty() && first != "split" && first != "cluster" && first != "--help" &&
             first != "-h") {
    subcommand = "cluster";
  }
  if (subcommand.empty()) return arguments;
  base::report_error(program, fmt::format("this is now called '{} {}'", kProgram, subcommand), 0);
  arguments.insert(arguments.begin(), subcommand);
  return arguments;
}

int run(int argc, char** argv) {
  CLI::App app("The time of a picture on a simulated cluster, as JSON on stdout", kProgram);
  app.require_subcommand(1);
  ReplayRequest replayed;
  CLI::App* cluster = app.add_subcommand(
      "cluster", "Producer and consumers, replayed from the recorded costs of tasks");
  add_replay_options(*cluster, replayed);
  cluster->callback([&] { run_replay(replayed, argv[0]); });
  SplitRequest divided;
  divided.job.structure = "beam";
  divided.job.split_level = 4;
  CLI::App* split = app.add_subcommand(
      "split", "A divided scene, actually traced; CPU times on this machine are scaled");
  add_split_options(*split, divided);
  split->callback([&] { trace_split(divided, argv[0]); });
  std::vector<std::string> arguments = with_subcommand(argc, argv);
  std::ranges::reverse(arguments);  // CLI11 takes arguments from the end
  try {
    app.parse(std::move(arguments));
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? base::kSuccess : base::kInvalidInput;
  }
  return base::kSuccess;
}

}  // namespace
}  // namespace beambench::cli

int main(int argc, char** argv) {
  using namespace beambench;
  base::prepare_process();
  try {
    return cli::run(argc, argv);
  } catch (const InputError& error) {
    return base::report_error("error", error.what(), base::kInvalidInput);
  } catch (const std::exception& error) {
    return base::report_failure("error", error);
  }
}
