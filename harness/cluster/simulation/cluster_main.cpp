// beambench-cluster-simulated: how long a recorded picture takes on a cluster that is described.

#include <cstdio>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/cluster/simulation/cluster_options.hpp"
#include "harness/cluster/simulation/simulated_cluster.hpp"
#include "scenes/core/error.hpp"

namespace beambench::cluster {
namespace {

using Json = nlohmann::ordered_json;

struct Request {
  std::string tasks;
  int consumers = 14;
  double walk_scale = 1.0;
  double work_scale = 1.0;
  double build_seconds = 0.0;
  double bytes_a_sample = 0.0;
  ClusterRequested cluster;
  ProducerOptions options;
};

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

int run(const Request& request, const char* program) {
  TaskCosts costs = slowed(read_task_costs(request.tasks), request.walk_scale, request.work_scale);
  if (request.bytes_a_sample > 0.0) {
    costs = with_results_of(request.bytes_a_sample, std::move(costs));
  }
  const SimulatedRun result = simulate(cluster_of(request.cluster, request.consumers + 1), costs,
                                       request.build_seconds, request.options, program);
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
  add_cluster_options(app, request.cluster);
  app.add_option("--batch", request.options.batch, "Tasks in a message")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000));
  app.add_option("--in-flight", request.options.in_flight, "Messages that a consumer may have")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  app.add_flag("--producer-consumes", request.options.consumes,
               "The producer does a task itself when no consumer waits");
}

int answer(int argc, char** argv) {
  CLI::App app("How long a recorded picture takes on a described cluster: JSON on stdout");
  Request request;
  add_options(app, request);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return run(request, argv[0]);
}

}  // namespace
}  // namespace beambench::cluster

int main(int argc, char** argv) {
  try {
    return beambench::cluster::answer(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
  }
  return 2;
}
