// beambench-cluster-simulated: how long a recorded picture takes on a cluster that is described.

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/cluster/simulation/simulated_cluster.hpp"
#include "scenes/error.hpp"

namespace beambench {
namespace {

using Json = nlohmann::ordered_json;

struct Request {
  std::string tasks;
  int consumers = 14;
  std::string network = "switched";
  double walk_scale = 1.0;
  double work_scale = 1.0;
  double build_seconds = 0.0;
  double bytes_a_sample = 0.0;
  std::vector<double> speeds;
  ClusterModel cluster;
  ProducerOptions options;
};

/// The producer's speed and the consumers'; those that are given are repeated.
std::vector<double> all_speeds(const Request& request) {
  std::vector<double> speeds{1.0};
  for (int i = 0; i < request.consumers; ++i) {
    const std::size_t given = request.speeds.size();
    speeds.push_back(given == 0 ? 1.0 : request.speeds[static_cast<std::size_t>(i) % given]);
  }
  return speeds;
}

Json process_json(std::size_t number, const ProcessReport& process) {
  return {{"process", number},
          {"role", number == 0 ? "producer" : "consumer"},
          {"tasks", process.tasks},
          {"samples", process.samples},
          {"busy_seconds", process.busy_seconds},
          {"wait_seconds", process.wait_seconds},
          {"last_seconds", process.last_result}};
}

Json to_json(const TaskCosts& costs, double build_seconds, const SimulatedRun& run) {
  Json processes = Json::array();
  Traffic down;
  Traffic up;
  for (std::size_t i = 0; i < run.report.processes.size(); ++i) {
    const ProcessReport& process = run.report.processes[i];
    processes.push_back(process_json(i, process));
    down.messages += process.from_producer.messages;
    down.bytes += process.from_producer.bytes;
    up.messages += process.to_producer.messages;
    up.bytes += process.to_producer.bytes;
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

int run(Request& request, const char* program) {
  TaskCosts costs = slowed(read_task_costs(request.tasks), request.walk_scale, request.work_scale);
  if (request.bytes_a_sample > 0.0) {
    costs = with_results_of(request.bytes_a_sample, std::move(costs));
  }
  request.cluster.network = request.network == "shared" ? ClusterModel::Network::kShared
                                                        : ClusterModel::Network::kSwitched;
  request.cluster.speeds = all_speeds(request);
  const SimulatedRun result =
      simulate(request.cluster, costs, request.build_seconds, request.options, program);
  fmt::print("{}\n", to_json(costs, request.build_seconds, result).dump(1));
  return 0;
}

void add_options(CLI::App& app, Request& request) {
  const CLI::Range positive(1e-12, 1e12);
  const CLI::Range not_negative(0.0, 1e12);
  app.add_option("TASKS", request.tasks, "What 'beambench-cluster SCENE --tasks FILE.csv' recorded")
      ->required();
  app.add_option("--consumers", request.consumers, "Processes beside the producer")
      ->capture_default_str()
      ->check(CLI::Range(0, 4095));
  app.add_option("--walk-scale", request.walk_scale,
                 "A machine of speed 1 takes so many times the recorded time to walk beams")
      ->check(positive);
  app.add_option("--work-scale", request.work_scale, "... and for all other work")->check(positive);
  app.add_option("--build-seconds", request.build_seconds,
                 "Before the first beam, in every process: to read the scene and build the octree")
      ->check(not_negative);
  app.add_option("--sample-bytes", request.bytes_a_sample,
                 "Results have so many bytes a sample; if not given, as many as were recorded")
      ->check(positive);
  app.add_option("--network", request.network,
                 "shared: one medium for all; switched: a line in both directions for each machine")
      ->capture_default_str()
      ->check(CLI::IsMember({"shared", "switched"}));
  ClusterModel& cluster = request.cluster;
  app.add_option("--bandwidth", cluster.bytes_per_second, "Bytes a second, of the medium or a line")
      ->capture_default_str()
      ->check(positive);
  app.add_option("--latency", cluster.latency_seconds, "Seconds between two machines")
      ->capture_default_str()
      ->check(not_negative);
  app.add_option("--message-seconds", cluster.message_cost.message_seconds,
                 "Of the processor for a message, of the sender's and of the receiver's")
      ->capture_default_str()
      ->check(not_negative);
  app.add_option("--byte-seconds", cluster.message_cost.byte_seconds, "... and for each byte of it")
      ->capture_default_str()
      ->check(not_negative);
  app.add_option("--look-seconds", cluster.message_cost.look_seconds,
                 "Of the processor to look for messages where there is none")
      ->capture_default_str()
      ->check(positive);
  app.add_option("--speeds", request.speeds, "Of the consumers' machines, repeated: 1,0.5")
      ->delimiter(',')
      ->check(positive);
  app.add_option("--loaded", cluster.loaded, "So many machines are used by others now and then");
  app.add_option("--loaded-share", cluster.loaded_share, "What others leave of them")
      ->capture_default_str()
      ->check(CLI::Range(1e-3, 1.0));
  app.add_option("--load-period", cluster.load_period,
                 "Seconds, in the second half of which others use them")
      ->capture_default_str()
      ->check(positive);
  app.add_option("--batch", request.options.batch, "Tasks in a message")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000));
  app.add_option("--in-flight", request.options.in_flight, "Messages that a consumer may have")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  app.add_flag("--producer-consumes", request.options.consumes,
               "The producer does a task itself when no consumer waits");
}

}  // namespace
}  // namespace beambench

int main(int argc, char** argv) {
  CLI::App app("How long a recorded picture takes on a described cluster: JSON on stdout");
  beambench::Request request;
  beambench::add_options(app, request);
  try {
    app.parse(argc, argv);
    return beambench::run(request, argv[0]);
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);
    return code == 0 ? 0 : 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 2;
  }
}
