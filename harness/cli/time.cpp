// beambench time: times a few structures immediately, without a sweep file.

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "accel/core/registry.hpp"
#include "harness/analysis/words.hpp"
#include "harness/base/messages.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/inputs.hpp"
#include "harness/cli/interruption.hpp"
#include "harness/measure/sweep_run.hpp"
#include "harness/measure/tuning.hpp"
#include "harness/plugin/load_plugin.hpp"
#include "harness/rays/ray_kind.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/files.hpp"
#include "scenes/base/json_text.hpp"
#include "scenes/base/printable.hpp"

namespace beambench::cli {
namespace {

/// The limit for `exhaustive`, as in the default sweep: above it, `exhaustive` would use up all the
/// available time.
constexpr int kMaxForExhaustive = 1000;

struct TimeRequest {
  std::vector<std::string> scenes;
  std::string structures = "tile-beam,sah-bvh,embree";
  std::string camera;
  std::string resolution = "640x480";
  std::vector<std::string> rays{"primary"};
  int samples = 1;
  int threads = 1;
  double seconds = 20.0;
  std::string save;
  bool verbose = false;
};

/// The beginning of messages about the sweep of a request.
constexpr std::string_view kSweepName = "beambench time";

/// A temporary folder for a run that is not kept.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string path = (std::filesystem::temp_directory_path() / "beambench-time-XXXXXX").string();
    if (::mkdtemp(path.data()) == nullptr) {
      throw InputError(
          fmt::format("cannot create a folder in {}; set TMPDIR to one with free space",
                      std::filesystem::temp_directory_path().string()));
    }
    path_ = path;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

nlohmann::json scenes_of(const TimeRequest& request) {
  nlohmann::json scenes = nlohmann::json::array();
  for (const std::string& scene : request.scenes) {
    if (request.camera.empty()) {
      scenes.push_back(scene);
    } else {
      scenes.push_back({{"scene", scene}, {"cameras", {request.camera}}});
    }
  }
  return scenes;
}

/// Returns the structures in the form of `beambench run`. Embree without parameters is tuned,
/// because its defaults are a mode that hardly any program would choose.
nlohmann::json structures_of(const std::string& text) {
  nlohmann::json structures = nlohmann::json::array();
  for (const measure::SweptStructure& swept : measure::read_structures(text, accel::registry())) {
    const std::string label = swept.sets.front().short_label();
    structures.push_back(swept.is_tuned || label == "embree" ? measure::kBestEmbreeText : label);
  }
  return structures;
}

/// Returns each kind of rays once. They may be separated by commas or given as several words.
std::vector<std::string> rays_of(const TimeRequest& request) {
  std::vector<std::string> kinds;
  for (const rays::RayChoice& choice :
       rays::parse_ray_choices(fmt::format("{}", fmt::join(request.rays, ",")))) {
    kinds.push_back(choice.file.empty() ? choice.label : choice.file.string());
  }
  return kinds;
}

/// Replaces the JSON pointer at the beginning of a message with the option's name.
std::string with_option_name(std::string message) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 7> kOptions{
      {{"scenes", "SCENE"},
       {"structures", "--accel"},
       {"resolutions", "--resolution"},
       {"samples", "--samples"},
       {"rays", "--rays"},
       {"threads", "--threads"},
       {"budget_seconds", "--seconds"}}};
  for (const auto& [key, option] : kOptions) {
    if (!message.starts_with(fmt::format("{}: /{}", kSweepName, key))) continue;
    const std::size_t text = message.find(": ", kSweepName.size() + 2);
    return std::string(option) + message.substr(text);
  }
  return message;
}

/// Returns the request in the form of `beambench run`. Requires at least six repetitions, because
/// fewer yield no interval, and nothing would be decided.
nlohmann::json sweep_of(const TimeRequest& request) {
  return {{"name", "time"},
          {"description", "Written by beambench time --save."},
          {"scenes", scenes_of(request)},
          {"structures", structures_of(request.structures)},
          {"resolutions", {request.resolution}},
          {"samples", {request.samples}},
          {"rays", rays_of(request)},
          {"threads", request.threads},
          {"precision", 0.02},
          {"repetitions", {{"minimum", 6}, {"maximum", 200}}},
          {"budget_seconds", request.seconds},
          {"exclude", {{{"structure", "exhaustive"}, {"primitives_above", kMaxForExhaustive}}}}};
}

/// Throws unless the sweep can be saved: it is JSON, so its strings must be UTF-8.
void require_can_be_saved(const TimeRequest& request) {
  for (const std::string& scene : request.scenes) {
    if (is_utf8(scene)) continue;
    throw InputError(fmt::format(
        "--save: the sweep cannot contain the path '{}', which is not UTF-8; rename the file",
        scene));
  }
}

/// Returns configuration and plan. Throws InputError naming the option.
std::pair<measure::SweepConfig, measure::Plan> plan_of(const TimeRequest& request) {
  try {
    measure::SweepConfig config =
        measure::parse_sweep(sweep_of(request), std::string(kSweepName), accel::registry());
    measure::Plan plan = measure::make_plan(config);
    return {std::move(config), std::move(plan)};
  } catch (const InputError& error) {
    throw InputError(with_option_name(error.what()));
  }
}

int time_structures(const TimeRequest& request) {
  if (!request.save.empty()) require_can_be_saved(request);
  Interruption interruption("interrupted; nothing was kept");
  refuse_structures_as_scenes(request.scenes);
  const auto [config, planned] = plan_of(request);
  measure::Plan plan = std::move(planned);
  if (plan.merged > 0) {
    base::print_message(stderr, "duplicates are timed once\n");
  }
  if (!request.save.empty()) write_file(request.save, json_text(config.source) + "\n");
  const TemporaryFolder folder;
  interruption.set_folder_to_remove(folder.path());
  measure::SweepOptions options;
  options.folder = folder.path();
  options.line_per_cell = request.verbose;
  options.block_program = plugin::program_words();
  const measure::GoogleBenchmark benchmark(measure::parse_benchmark_flags({}));
  const analysis::Analysis found = analysis::analyze(
      measure::read_run(measure::run_sweep(config, std::move(plan), benchmark, options, stderr)));
  fmt::print("{}", analysis::describe_contenders(found.views));
  if (found.views.size() > 1) fmt::print("{}\n", analysis::describe(found.views));
  fmt::print("{}", analysis::describe_verdicts(found));
  return analysis::exit_code_of(found);
}

}  // namespace

void add_time_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "time", "Time a few structures without a sweep: which is fastest, by how much");
  const auto request = std::make_shared<TimeRequest>();
  command->add_option("SCENE", request->scenes, kSceneHelp)->required();
  command
      ->add_option(
          "--accel", request->structures,
          "Structures as named by 'beambench list', separated by commas, or 'all'; 'embree' means "
          "embree:mode=best, whose modes and flags are tried with a tuning camera")
      ->capture_default_str();
  command->add_option("--camera", request->camera,
                      "Name of the camera (default: each scene's first)");
  command->add_option("--resolution", request->resolution, "WIDTHxHEIGHT")->capture_default_str();
  command
      ->add_option("--rays", request->rays,
                   "Kinds of rays as in 'beambench rays SCENE --rays', separated by commas; each "
                   "is timed separately")
      ->type_name("KIND[,KIND...]")
      ->capture_default_str();
  command->add_option("--samples", request->samples, "Samples per pixel")->capture_default_str();
  command
      ->add_option("--threads", request->threads,
                   "Threads that trace an image or a list (1 to 1024)")
      ->check(whole_number_in(1, 1024))
      ->capture_default_str();
  command
      ->add_option("--seconds", request->seconds,
                   "Time for all repetitions; each contender gets at least six")
      ->check(number_in(0.1, 1e6))
      ->capture_default_str();
  command->add_option("--save", request->save,
                      "Also write the request as a sweep, for 'beambench run FILE'");
  add_verbose_option(*command, request->verbose);
  command->footer(
      "Contenders take turns, each repetition rebuilds its structure, and every hit is verified.\n"
      "Examples:\n"
      "  beambench time balls:n=3 --accel samet,sah-bvh,embree --seconds 5\n"
      "  beambench time tetra:n=3 --accel all --rays primary,shadow --seconds 5 --save mine.json");
  command->callback([request, &exit_code] { exit_code = time_structures(*request); });
}

}  // namespace beambench::cli
