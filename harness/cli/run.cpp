// beambench run: measures a sweep.

#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/analysis/exports.hpp"
#include "harness/analysis/words.hpp"
#include "harness/base/messages.hpp"
#include "harness/base/stopwatch.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/inputs.hpp"
#include "harness/cli/interruption.hpp"
#include "harness/measure/division.hpp"
#include "harness/measure/record/other_work.hpp"
#include "harness/measure/record/run_log.hpp"
#include "harness/measure/record/shard.hpp"
#include "harness/measure/sweep_run.hpp"
#include "harness/plugin/load_plugin.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/json_text.hpp"
#include "scenes/base/shell_word.hpp"

namespace beambench::cli {
namespace {

struct RunRequest {
  std::string config;
  std::string output;
  std::string resume;
  std::optional<std::string> shard;
  bool verbose = false;
  bool dry_run = false;
  bool json = false;
  std::optional<double> quiet_minutes;  ///< maximum time to wait for a quiet machine
  std::vector<std::string> benchmark_flags;
};

/// Returns the configuration from the named file, or the configuration of the run to be resumed.
measure::SweepConfig config_of(const RunRequest& request,
                               const std::optional<measure::Run>& earlier) {
  if (!request.config.empty()) return measure::read_sweep(request.config, accel::registry());
  if (earlier) {
    const std::filesystem::path log = std::filesystem::path(request.resume) / measure::kLogName;
    return measure::parse_sweep(earlier->config, log.string() + ", config", accel::registry());
  }
  throw InputError(
      "no sweep given; name one, such as quick, or a JSON file, or resume a run with --resume "
      "DIR");
}

measure::SweepOptions options_of(const RunRequest& request) {
  measure::SweepOptions options;
  options.block_program = plugin::program_words();
  options.resume = !request.resume.empty();
  if (options.resume) options.folder = request.resume;
  if (!request.output.empty()) options.folder = request.output;
  options.line_per_cell = request.verbose;
  return options;
}

/// Applies --benchmark_repetitions=N: exactly N, also in the saved configuration.
void override_repetitions(measure::SweepConfig& config, int repetitions) {
  config.minimum_repetitions = config.maximum_repetitions = repetitions;
  config.source["repetitions"] = {{"minimum", repetitions}, {"maximum", repetitions}};
}

std::vector<std::string> cell_names(const measure::Plan& plan) {
  std::vector<std::string> names;
  for (const measure::CellGroup& group : plan.groups) {
    for (const measure::PlannedCell& cell : group.cells) names.push_back(cell.id.name());
  }
  return names;
}

/// Returns the cells in the order of the records.
nlohmann::ordered_json to_json(const measure::Plan& plan) {
  nlohmann::ordered_json cells = nlohmann::ordered_json::array();
  for (const measure::CellGroup& group : plan.groups) {
    for (const measure::PlannedCell& cell : group.cells) {
      cells.push_back({{"name", cell.id.name()},
                       {"scene", cell.id.scene},
                       {"primitives", group.scene->primitives.size()},
                       {"camera", cell.id.camera},
                       {"width", cell.id.resolution.width},
                       {"height", cell.id.resolution.height},
                       {"samples", cell.id.samples},
                       {"rays", cell.id.rays},
                       {"structure", cell.id.structure},
                       {"parameters", cell.id.parameters},
                       {"threads", group.threads}});
    }
  }
  return {{"cells", cells}};
}

/// Returns the shard to be measured: the requested one, or that of the run to be resumed.
std::optional<measure::Shard> shard_of(const RunRequest& request,
                                       const std::optional<measure::Run>& earlier) {
  if (request.shard) return measure::parse_shard(*request.shard);
  if (!earlier) return std::nullopt;
  const std::filesystem::path log = std::filesystem::path(request.resume) / measure::kLogName;
  const auto facts = read_as_written(log.string(), "begin a new run with -o",
                                     [&] { return measure::shard_of_manifest(earlier->manifest); });
  return facts ? std::optional(facts->shard) : std::nullopt;
}

/// Throws InputError for a filtered shard, because a shard is recognized as complete by its number
/// of cells.
void refuse_filtered_shard(const measure::BenchmarkFlags& flags) {
  for (const std::string& flag : flags.passed_on) {
    if (!flag.starts_with("--benchmark_filter")) continue;
    throw InputError(
        fmt::format("{}: a shard must be measured completely; leave the flag out, or write a sweep "
                    "with the cells that you want",
                    flag));
  }
}

/// Returns all cells of the configuration.
measure::Plan whole_plan(const measure::SweepConfig& config) {
  measure::Plan plan = measure::make_plan(config);
  if (plan.merged > 0) {
    base::print_message(
        stderr,
        fmt::format("{} duplicate cells of the configuration are measured once\n", plan.merged));
  }
  return plan;
}

/// Keeps only the cells of one shard, and reports their number.
measure::PlannedShard reduce_to_shard(measure::Plan& plan, const measure::SweepConfig& config,
                                      const measure::Shard& shard) {
  measure::PlannedShard planned = measure::keep_shard(plan, config, shard);
  fmt::print(stderr, "shard {}: {} of {}, {:.0f}% of the estimated work\n",
             measure::to_string(shard), planned.facts.cells,
             base::counted(planned.facts.cells_of_sweep, "cell"), 100.0 * planned.share);
  return planned;
}

/// Keeps only the cells selected by --benchmark_filter.
void select_cells(measure::Plan& plan, const measure::GoogleBenchmark& benchmark) {
  const std::set<std::string> selected = benchmark.select(cell_names(plan));
  measure::filter_cells(
      plan, [&](const measure::PlannedCell& cell) { return selected.contains(cell.id.name()); });
}

/// Writes the files of a run from its log, and prints the conclusions.
int conclude(const std::filesystem::path& folder) {
  const analysis::Analysis found = analysis::conclude(folder);
  if (!found.overheads.empty()) {
    base::print_message(stderr, fmt::format("{}\n", analysis::describe(found.overheads)));
  }
  base::print_message(stderr, fmt::format("\n{}", analysis::summary(found)));
  fmt::print("{}\n", (folder / "results.csv").string());
  return analysis::exit_code_of(found);
}

std::string resume_command(const std::filesystem::path& folder) {
  return fmt::format("{} run --resume {}", plugin::program_call_here(),
                     shell_quoted(folder.string()));
}

/// Waits until other work is too little to disturb times. Throws InputError if this takes too long.
void wait_for_quiet(double minutes) {
  const base::Stopwatch watch;
  for (bool first = true;; first = false) {
    const measure::OtherWork other;
    std::this_thread::sleep_for(std::chrono::seconds(1));
    const double busy = other.processors().value_or(0.0);
    if (busy <= measure::kQuiet) return;
    if (watch.seconds() >= 60.0 * minutes) {
      throw InputError(
          fmt::format("--require-quiet: after {:g} minutes, other work still keeps {:.2f} "
                      "processors busy, more than {}; stop it, or wait longer",
                      minutes, busy, measure::kQuiet));
    }
    if (first) {
      base::print_message(
          stderr, fmt::format("Waiting up to {:g} minutes until other work, which keeps {:.2f} "
                              "processors busy, keeps at most {} busy.\n",
                              minutes, busy, measure::kQuiet));
    }
  }
}

/// Runs the sweep; however it is interrupted, the last line states how to resume it. Returns the
/// exit code.
int run_resumable(const measure::SweepConfig& config, measure::Plan plan,
                  const measure::GoogleBenchmark& benchmark, measure::SweepOptions options,
                  Interruption& interruption) {
  std::string resume;
  options.begun = [&](const std::filesystem::path& folder) {
    resume = resume_command(folder);
    interruption.set_last_line(
        fmt::format("interrupted; every repetition is kept; resume with: {}", resume));
  };
  try {
    return conclude(measure::run_sweep(config, std::move(plan), benchmark, options, stderr));
  } catch (const InputError& error) {
    if (resume.empty()) throw;
    throw InputError(fmt::format("{}; then resume with: {}", error.what(), resume));
  }
}

int run(const RunRequest& request) {
  Interruption interruption("interrupted; nothing was measured yet");
  const measure::BenchmarkFlags flags = measure::parse_benchmark_flags(request.benchmark_flags);
  for (const std::string& note : flags.notes) {
    base::print_message(stderr, fmt::format("{}\n", note));
  }
  std::optional<measure::Run> earlier;
  if (!request.resume.empty()) earlier = measure::read_run(request.resume);
  measure::SweepConfig config = config_of(request, earlier);
  if (flags.repetitions) override_repetitions(config, *flags.repetitions);
  measure::SweepOptions options = options_of(request);
  const std::optional<measure::Shard> shard = shard_of(request, earlier);
  earlier.reset();  // its cells use memory
  if (shard) refuse_filtered_shard(flags);
  const measure::GoogleBenchmark benchmark(flags);
  measure::Plan plan = whole_plan(config);
  if (shard) options.shard = reduce_to_shard(plan, config, *shard);
  select_cells(plan, benchmark);
  if (request.dry_run || flags.list) {
    if (request.json) fmt::print("{}\n", json_text(to_json(plan)));
    for (const std::string& name : cell_names(plan)) {
      if (!request.json) fmt::print("{}\n", name);
    }
    return base::kSuccess;
  }
  if (request.quiet_minutes) wait_for_quiet(*request.quiet_minutes);
  return run_resumable(config, std::move(plan), benchmark, std::move(options), interruption);
}

}  // namespace

void add_run_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("run", "Measure a sweep: a time is reported only if the hits are correct");
  const auto request = std::make_shared<RunRequest>();
  command->add_option("CONFIG", request->config,
                      "The sweep: a name, such as quick, or a JSON file");
  CLI::Option* output =
      command->add_option("-o,--output", request->output,
                          "Folder for the record (default: results/runs/<time>-<name>)");
  CLI::Option* resume =
      command
          ->add_option("--resume", request->resume,
                       "Resume the run in this folder, keeping all its repetitions")
          ->excludes(output);
  command
      ->add_option("--shard", request->shard,
                   "Measure only shard K of N. Shards have equal estimated times and are measured "
                   "on different machines; 'beambench merge' joins them")
      ->type_name("K/N")
      ->excludes(resume);
  command
      ->add_option("--require-quiet", request->quiet_minutes,
                   "Wait until other work keeps at most 0.1 processors busy, up to this time, and "
                   "end with exit code 2 if it keeps more busy")
      ->type_name("MINUTES")
      ->check(number_in(0.0, 1e5));
  add_verbose_option(*command, request->verbose);
  CLI::Option* dry_run =
      command->add_flag("--dry-run", request->dry_run, "Print the names of the cells and stop");
  command
      ->add_flag("--json", request->json,
                 "Print JSON instead: each cell's name, scene, primitives, camera, width, height, "
                 "samples, rays, structure, parameters and threads")
      ->needs(dry_run);
  command->allow_extras();
  command->footer(
      "These flags of Google Benchmark are accepted: --benchmark_filter=REGEX\n"
      "(over the names that --dry-run prints), --benchmark_repetitions=N,\n"
      "--benchmark_list_tests, --benchmark_context=KEY=VALUE, --v=N.\n"
      "Examples:\n"
      "  beambench run quick\n"
      "  beambench run quick -o my-run --benchmark_filter=tetra.*samet\n"
      "  beambench run --resume my-run\n"
      "  beambench run quick --shard 2/4 -o shards/2");
  command->callback([command, request, &exit_code] {
    request->benchmark_flags = command->remaining();
    exit_code = run(*request);
  });
}

}  // namespace beambench::cli
