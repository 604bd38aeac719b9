#include "harness/cluster/request.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "harness/bench/record/build_info.hpp"
#include "harness/cli/inputs.hpp"
#include "harness/cli/whitted_request.hpp"
#include "harness/render/picture/image_file.hpp"
#include "scenes/core/error.hpp"
#include "scenes/core/files.hpp"

namespace beambench::cluster {
namespace {

constexpr const char* kDescription =
    "One image on several processes, as chapter 6 of the thesis has it: process 0 walks the "
    "beams,\n"
    "the others trace those that come to occupied leaves. Start it with mpirun.";
constexpr const char* kFooter =
    "The picture is the one of 'beambench render', bit for bit, on any number of processes.\n"
    "A process that dies ends the run (exit code not 0, no picture); one that is silent for\n"
    "--timeout seconds is given up, and others do its work.\n"
    "Examples:\n"
    "  mpirun -n 3 beambench-cluster balls -o balls.png --shade whitted --samples 5\n"
    "  mpirun -n 5 beambench-cluster tetra:n=8 -o tetra.png --batch 16 --in-flight 2\n"
    "  mpirun -n 3 beambench-cluster escena1 -o escena1.png --report run.json --tasks tasks.csv\n"
    "As root in a container: mpirun --allow-run-as-root --oversubscribe ...";

/// Options as they are typed.
struct Typed {
  std::string scene;
  std::string structure = "beam";
  cli::ImageRequest image;
  std::string shading = "preview";
  cli::WhittedRequest whitted;
  std::string work = "beams";
};

void add_options(CLI::App& app, Typed& typed, ClusterRequest& request) {
  cli::add_scene_option(app, typed.scene);
  app.add_option("-o", request.picture, "Picture to write, .png or .exr (default: none)");
  app.add_option("--accel", typed.structure, "beam, with parameters: beam:max_level=6,...")
      ->capture_default_str();
  cli::add_size_options(app, typed.image);
  cli::add_camera_option(app, typed.image.view);
  app.add_option("--shade", typed.shading,
                 "preview, normals, id, depth: consumers find hits; whitted: they follow light")
      ->capture_default_str();
  cli::add_light_options(app, typed.whitted);
  app.add_option("--work", typed.work, "beams, or blocks of the image traced by individual rays")
      ->capture_default_str()
      ->check(CLI::IsMember({"beams", "blocks"}));
  app.add_option("--split", request.job.split_level,
                 "Divide the scene instead: each process has the primitives in its share of the "
                 "octree's cells of this level, and beams and rays are handed over at borders")
      ->check(CLI::Range(2, 7));
  app.add_option("--block", request.block_size, "Pixels along the side of a block")
      ->capture_default_str()
      ->check(CLI::Range(1, 4096));
  app.add_option("--batch", request.producer.batch, "Beams or blocks in a message")
      ->capture_default_str()
      ->check(CLI::Range(1, 100000));
  app.add_option("--in-flight", request.producer.in_flight,
                 "Messages that a consumer may have at a time; 2: the next one waits for it")
      ->capture_default_str()
      ->check(CLI::Range(1, 64));
  app.add_flag("--producer-consumes", request.producer.consumes,
               "Process 0 does the work itself when no consumer waits");
  app.add_option("--timeout", request.producer.timeout,
                 "Seconds after which a silent consumer is given up")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 1e6));
  app.add_option("--report", request.report, "JSON: messages, bytes, busy times of each process");
  app.add_option("--tasks", request.tasks, "CSV: cost and size of each beam or block");
}

/// Who shades must have what was hit.
void require_hits_alone(const ClusterRequest& request) {
  const bool needs_scene =
      request.shading != render::Shading::kId && request.shading != render::Shading::kDepth;
  if (!request.picture.empty() && needs_scene) {
    throw InputError(
        "--split makes pictures of what was hit and how far away it is, for no process has the "
        "whole scene; give --shade id or --shade depth");
  }
  if (request.blocks || !request.tasks.empty()) {
    throw InputError(
        "--split divides the scene, not the work; leave out --work blocks and --tasks");
  }
}

void fill(const Typed& typed, ClusterRequest& request) {
  request.shading = render::parse_shading(typed.shading);
  request.blocks = typed.work == "blocks";
  Job& job = request.job;
  job.scene = typed.scene;
  job.structure = cli::choose_one("--accel", typed.structure).label();
  job.camera = typed.image.view.camera;
  if (!typed.image.resolution.empty()) {
    const rays::Resolution resolution = rays::parse_resolution(typed.image.resolution);
    job.width = resolution.width;
    job.height = resolution.height;
  }
  job.samples = typed.image.samples;
  accel::sample_offsets(job.samples);
  job.light = request.shading == render::Shading::kWhitted;
  job.whitted = cli::whitted_options(typed.whitted);
  job.alive_every = std::min(1.0, 0.25 * request.producer.timeout);
  if (job.split_level > 0) require_hits_alone(request);
  if (!request.picture.empty()) render::image_format(request.picture);
  for (const std::string& file : {request.picture, request.report, request.tasks}) {
    if (!file.empty()) require_writable(file);
  }
}

}  // namespace

std::optional<ClusterRequest> parse_request(int argc, char** argv) {
  CLI::App app(kDescription, "beambench-cluster");
  app.set_version_flag("--version",
                       fmt::format("beambench-cluster {}", bench::build_info().version));
  app.footer(kFooter);
  app.get_formatter()->column_width(34);
  Typed typed;
  ClusterRequest request;
  add_options(app, typed, request);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    app.exit(success);
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    throw InputError(fmt::format("{}; see 'beambench-cluster --help'", error.what()));
  }
  fill(typed, request);
  return request;
}

}  // namespace beambench::cluster
