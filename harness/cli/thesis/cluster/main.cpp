// beambench-cluster: computes one image on the processes that mpirun starts.

#include <algorithm>
#include <cstdio>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "accel/core/threads.hpp"
#include "harness/base/messages.hpp"
#include "harness/base/process_start.hpp"
#include "harness/cli/inputs.hpp"
#include "harness/cli/thesis/cluster/division_option.hpp"
#include "harness/measure/record/machine.hpp"
#include "harness/rays/hit_check.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/render/picture/image_file.hpp"
#include "harness/thesis/cluster/image_division.hpp"
#include "harness/thesis/cluster/kept_results.hpp"
#include "harness/thesis/cluster/mpi_session.hpp"
#include "harness/thesis/cluster/mpi_transport.hpp"
#include "harness/thesis/cluster/run.hpp"
#include "harness/thesis/cluster/split/scene_division.hpp"
#include "harness/thesis/cluster/split/split_run.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/files.hpp"

namespace beambench::cli {
namespace {

using namespace cluster;

constexpr const char* kProgram = "beambench-cluster";
constexpr const char* kDescription =
    "One image on several processes (thesis, chapter 6): process 0 traces beams to occupied\n"
    "leaves, the others trace their rays. Start it with mpirun.";
constexpr const char* kFooter =
    "The picture is that of 'beambench render', bit for bit, with any number of processes.\n"
    "A process that dies ends the run (exit code not 0, no picture); the same command with\n"
    "--resume then continues with the finished results. A process that is silent for\n"
    "--timeout seconds is declared lost, and its work is done by others.\n"
    "Examples:\n"
    "  mpirun -n 3 beambench-cluster balls -o balls.png --shade whitted --samples 5\n"
    "  mpirun -n 5 beambench-cluster tetra:n=8 -o tetra.png --batch 16 --in-flight 2\n"
    "  mpirun -n 3 beambench-cluster balls -o balls.png --shade whitted --split 4\n"
    "  mpirun -n 99 beambench-cluster tetra:n=8 -o tetra.png --work tiles --results stored\n"
    "  mpirun -n 3 beambench-cluster escena1 -o escena1.png --report run.json --tasks tasks.csv\n"
    "As root in a container: mpirun --allow-run-as-root --oversubscribe ...";

/// The unparsed options.
struct Options {
  std::string scene;
  std::string structure = "beam";
  ImageRequest image;
  std::string shading = "preview";
  WhittedRequest whitted;
  std::string work = "beams";
  std::string division = "primitives";
  std::string results = "sent";
  bool resume = false;
};

void add_timeout_option(CLI::App& app, double& seconds) {
  app.add_option("--timeout", seconds,
                 "Seconds after which a silent consumer is declared lost, or the run ends because "
                 "no other can do the work of a silent process; also the limit for starting MPI")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 1e6));
}

/// Returns the time limit, which every process needs before it receives messages. Process 0 reports
/// errors in the options later.
double timeout_of(int argc, const char* const* argv) {
  double seconds = ProducerOptions{}.timeout;
  CLI::App app;
  app.set_help_flag();
  app.allow_extras();
  add_timeout_option(app, seconds);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError&) {
    return ProducerOptions{}.timeout;
  }
  return seconds;
}

void add_options(CLI::App& app, Options& typed, ClusterRequest& request) {
  add_scene_option(app, typed.scene);
  app.add_option("-o", request.picture, "Picture to write, .png or .exr (default: none)");
  app.add_option("--accel", typed.structure, "beam, with parameters: beam:max_level=6,...")
      ->capture_default_str();
  add_size_options(app, typed.image);
  add_camera_option(app, typed.image.view);
  app.add_option("--shade", typed.shading,
                 "preview, normals, id, depth: consumers send hits; whitted: they send light")
      ->capture_default_str();
  add_light_options(app, typed.whitted);
  app.add_option("--work", typed.work,
                 "beams; blocks of the image traced by individual rays; tiles, blocks whose beams "
                 "the consumers make themselves; or a static division: contiguous and interlaced "
                 "rows, windows (interlaced blocks), pre-pass (blocks of equal estimated cost)")
      ->capture_default_str()
      ->check(CLI::IsMember(
          {"beams", "blocks", "tiles", "contiguous", "interlaced", "windows", "pre-pass"}));
  app.add_option("--split", request.job.split_level,
                 "Divide the scene instead: each process has the primitives in its share of the "
                 "octree's cells of this level; beams and rays are passed on at borders. Process 0 "
                 "shades, for which it keeps the whole scene, unless --shade is id or depth")
      ->check(CLI::Range(2, 7));
  add_division_option(app, typed.division)->needs("--split");
  app.add_option("--block", request.block_size, "Side of a block or tile in pixels")
      ->capture_default_str()
      ->check(CLI::Range(1, 4096));
  app.add_option("--batch", request.producer.batch,
                 "Beams or blocks per message; for tiles, decreasing numbers if not given")
      ->capture_default_str()
      ->each([&](const std::string&) { request.batch_given = true; })
      ->check(CLI::Range(1, 100000));
  app.add_option("--in-flight", request.producer.in_flight,
                 "Messages that a consumer may hold; 2: the next one arrives in advance")
      ->capture_default_str()
      ->check(CLI::Range(1, 64));
  app.add_flag("--producer-consumes", request.producer.consumes,
               "Process 0 performs tasks while no consumer waits");
  app.add_option(
         "--results", typed.results,
         "sent to process 0; stored: every process keeps its results in FILE.kept, which all "
         "processes must see, and process 0 reads them at the end (with -o FILE)")
      ->capture_default_str()
      ->check(CLI::IsMember({"sent", "stored"}));
  app.add_flag("--resume", typed.resume,
               "Continue an interrupted run of the same picture, whose finished results are in "
               "FILE.kept (with -o FILE)");
  add_timeout_option(app, request.producer.timeout);
  app.add_option("--report", request.report,
                 "Write JSON: messages, bytes, busy times of each process");
  app.add_option("--tasks", request.tasks, "Write CSV: cost and size of each beam or block");
}

void require_divisible(const ClusterRequest& request) {
  if (request.job.light && request.job.whitted.shadows != render::ShadowMethod::kRays) {
    throw InputError(
        "with --split, shadow rays are sent in batches, which caches and light buffers do not use; "
        "leave out --shadows; the picture is the same");
  }
  if (request.work != Work::kBeams || !request.tasks.empty()) {
    throw InputError("--split divides the scene, not the work; leave out --work and --tasks");
  }
}

/// Throws if an option is meaningless because the division determines the messages.
void require_fitting(const ClusterRequest& request) {
  const ProducerOptions usual;
  const ProducerOptions& given = request.producer;
  const bool more = given.batch != usual.batch || given.in_flight != usual.in_flight;
  if (is_static(request.work) && (more || given.consumes)) {
    throw InputError(
        fmt::format("--work {} gives each consumer all its work in one message; leave out --batch, "
                    "--in-flight and --producer-consumes",
                    name_of(request.work)));
  }
}

/// Keeps results in the folder beside the picture; only warns about a failure if the user did not
/// request this.
void keep_results(const Options& typed, ClusterRequest& request) {
  Job& job = request.job;
  if (request.picture.empty() || job.split_level > 0) return;
  job.work = name_of(request.work);
  const bool whole_rows = request.work == Work::kContiguous || request.work == Work::kInterlaced;
  if (request.work != Work::kBeams && !whole_rows) {
    job.work += fmt::format(" of {0} x {0} pixels", request.block_size);
  }
  const bool stored = typed.results == "stored";
  try {
    request.kept = std::make_shared<KeptFolder>(request.picture, typed.resume);
    if (stored) job.stored = request.kept->path();
  } catch (const InputError& error) {
    if (typed.resume || stored) throw;
    base::report_error(kProgram, fmt::format("{}; the run cannot be resumed", error.what()), 0);
  }
}

void fill(const Options& typed, ClusterRequest& request) {
  request.shading = render::parse_shading(typed.shading);
  request.work = work_named(typed.work).value_or(request.work);
  require_fitting(request);
  Job& job = request.job;
  job.scene = typed.scene;
  job.structure = choose_one("--accel", typed.structure).label();
  job.camera = typed.image.view.camera;
  job.resolution = chosen_resolution(typed.image).value_or(job.resolution);
  job.samples = typed.image.samples;
  accel::sample_offsets(job.samples);
  job.light = request.shading == render::Shading::kWhitted;
  job.whitted = whitted_options(typed.whitted);
  job.heartbeat_interval = std::min(1.0, 0.25 * request.producer.timeout);
  job.division = parse_scene_division(typed.division);
  const bool kept = typed.resume || typed.results == "stored";
  if (job.split_level > 0) {
    if (kept) throw InputError("--split does not keep results; leave out --resume and --results");
    require_divisible(request);
  }
  if (!request.picture.empty()) render::image_format(request.picture);
  for (const std::string& file : {request.picture, request.report, request.tasks}) {
    if (!file.empty()) require_writable(file);
  }
  if (kept && request.picture.empty()) {
    throw InputError("--resume and --results stored need -o FILE, beside which results are kept");
  }
  keep_results(typed, request);
}

/// Parses the command line; returns nothing after --help or --version. Throws InputError before any
/// long work.
std::optional<ClusterRequest> parse_request(int argc, char** argv) {
  CLI::App app(kDescription, kProgram);
  app.set_version_flag("--version", fmt::format("{} {}", kProgram, measure::build_info().version));
  app.footer(kFooter);
  app.get_formatter()->column_width(34);
  Options typed;
  ClusterRequest request;
  add_options(app, typed, request);
  try {
    std::vector<std::string> arguments(argv + 1, argv + argc);
    replace_renamed_options(kProgram, arguments);
    std::ranges::reverse(arguments);  // CLI11 takes arguments from the end
    app.parse(std::move(arguments));
  } catch (const CLI::Success& success) {
    app.exit(success);
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    throw InputError(fmt::format("{}; see 'beambench-cluster --help'", error.what()));
  }
  fill(typed, request);
  return request;
}

/// Runs process 0. The other processes receive the job, or nothing if there is none.
int lead_run(int argc, char** argv, MpiSession& session, Transport& transport) {
  std::optional<ClusterRequest> request;
  Bytes job;
  try {
    request = parse_request(argc, argv);
    if (request) job = write_job(request->job);
  } catch (...) {
    transport.broadcast(job);
    throw;
  }
  transport.broadcast(job);
  if (!request) return base::kSuccess;
  if (request->job.split_level > 0) {
    base::report_error(kProgram, summary(lead_split(*request, transport)), 0);
    return base::kSuccess;
  }
  session.allow_silence();
  const ClusterRun run = lead(*request, transport);
  for (const std::string& remark : run.report.remarks) base::report_error(kProgram, remark, 0);
  base::report_error(kProgram, summary(run), 0);
  if (run.report.lost.empty()) return base::kSuccess;
  // Lost processes would not reach MPI_Finalize, where all others would wait for them. All results
  // have been written.
  MpiSession::abort(base::kSuccess);
}

int run_process(int argc, char** argv, MpiSession& session, Transport& transport) {
  try {
    if (transport.self() == kProducer) return lead_run(argc, argv, session, transport);
    follow(transport);
    return base::kSuccess;
  } catch (const LostProcess& error) {
    base::report_error(kProgram, error.what(), base::kInvalidInput);
    MpiSession::abort(base::kInvalidInput);
  } catch (const InputError& error) {
    return base::report_error(kProgram, error.what(), base::kInvalidInput);
  } catch (const rays::InvalidHit& error) {  // the others wait for results that will never come
    base::report_error(kProgram, error.what(), base::kMismatch);
    MpiSession::abort(base::kMismatch);
  } catch (const std::exception& error) {
    base::report_failure(kProgram, error);
    MpiSession::abort(base::kInternalError);
  }
}

}  // namespace
}  // namespace beambench::cli

int main(int argc, char** argv) {
  using namespace beambench;
  base::prepare_process();
  cluster::MpiSession session(argc, argv, cli::timeout_of(argc, argv));
  cluster::MpiTransport transport(cluster::MpiTransport::Waiting::kSleeping);
  int code = base::kInternalError;
  accel::on_default_threads([&] { code = cli::run_process(argc, argv, session, transport); });
  return code;
}
