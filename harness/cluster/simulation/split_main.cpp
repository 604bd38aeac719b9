// beambench-split-simulated: how long a divided scene takes on a cluster that is described.

#include <cstdio>
#include <memory>
#include <new>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/cli/inputs.hpp"
#include "harness/cluster/simulation/cluster_options.hpp"
#include "harness/cluster/simulation/simulated_split.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/core/error.hpp"

namespace beambench::cluster {
namespace {

using Json = nlohmann::ordered_json;

struct Request {
  Job job;
  cli::ImageRequest image;
  int processes = 8;
  Slowness slowness;
  ClusterRequested cluster;
};

Json to_json(const SplitProcess& process) {
  const SplitAccount& account = process.account;
  return {{"primitives", account.primitives},
          {"bytes", account.scene_bytes + account.structure_bytes},
          {"beams_out", account.beams_out},
          {"rays_out", account.rays_out},
          {"messages_out", account.crossings_out.messages},
          {"bytes_out", account.crossings_out.bytes},
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

int run(const Request& request, const char* program) {
  const auto whole = std::make_shared<const scenes::Scene>(scenes::load_scene(request.job.scene));
  Job job = request.job;
  if (!request.image.resolution.empty()) {
    const rays::Resolution resolution = rays::parse_resolution(request.image.resolution);
    job.width = resolution.width;
    job.height = resolution.height;
  }
  job.camera = request.image.view.camera;
  job.samples = request.image.samples;
  const SimulatedSplit result = simulate_split(cluster_of(request.cluster, request.processes), job,
                                               whole, request.slowness, program);
  fmt::print("{}\n", to_json(*whole, result).dump(1));
  return 0;
}

void add_options(CLI::App& app, Request& request) {
  const CLI::Range positive(1e-12, 1e12);
  cli::add_scene_option(app, request.job.scene);
  app.add_option("--accel", request.job.structure, "beam, with parameters: beam:max_level=6,...")
      ->capture_default_str();
  cli::add_size_options(app, request.image);
  cli::add_camera_option(app, request.image.view);
  app.add_option("--split", request.job.split_level,
                 "Level of the octree's cells that are shared out")
      ->capture_default_str()
      ->check(CLI::Range(2, 7));
  app.add_option("--processes", request.processes, "So many parts")
      ->capture_default_str()
      ->check(CLI::Range(1, 1024));
  app.add_option("--build-scale", request.slowness.build,
                 "A machine of speed 1 takes so many times the time of this one to divide "
                 "the scene and to build")
      ->check(positive);
  app.add_option("--walk-scale", request.slowness.walk, "... to walk beams")->check(positive);
  app.add_option("--work-scale", request.slowness.work, "... for all other work")->check(positive);
  add_cluster_options(app, request.cluster);
}

int answer(int argc, char** argv) {
  CLI::App app(
      "How long a divided scene takes on a described cluster: JSON on stdout.\n"
      "It is really traced, and what it takes of this machine's processor is scaled.");
  Request request;
  request.job.structure = "beam";
  request.job.split_level = 4;
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
  } catch (const std::bad_alloc&) {
    std::fputs("error: the memory does not suffice; choose a smaller scene or resolution\n",
               stderr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
  }
  return 2;
}
