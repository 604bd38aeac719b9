// beambench stats: prints the sizes of structures and the work per ray.

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "accel/core/support.hpp"
#include "accel/core/tree_quality.hpp"
#include "harness/base/progress.hpp"
#include "harness/base/stopwatch.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/inputs.hpp"
#include "harness/cli/text.hpp"
#include "harness/rays/fingerprint.hpp"
#include "harness/rays/level_visits.hpp"
#include "harness/rays/trace_results.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/json_text.hpp"

namespace beambench::cli {
namespace {

using Json = nlohmann::ordered_json;

struct StatsRequest {
  std::string scene;
  std::string structures;
  std::string resolution = "320x200";
  ViewRequest view;
  std::string rays = "primary";
  bool levels = false;
  bool json = false;
};

/// The results for one structure.
struct Finding {
  accel::StructureChoice choice;
  accel::Statistics statistics;
  double build_ms = 0.0;
  std::uint64_t hits = 0;
  std::map<std::string, std::uint64_t, std::less<>> counters;
  std::vector<rays::LevelVisits> levels;
};

Finding examine(const accel::StructureChoice& choice, const scenes::Scene& scene,
                const rays::ImageOfRays& image, const rays::TraceInput& input, bool levels) {
  rays::require_support(choice, input);
  const base::Stopwatch stopwatch;
  const auto accelerator = choice.build(scene, rays::workload_of(image, input));
  const double build_ms = stopwatch.milliseconds();

  rays::TraceResults results = rays::make_results(input);
  accel::WorkCounters counters;
  rays::trace(*accelerator, input, results, &counters);
  Finding finding{choice, accelerator->statistics(), build_ms, 0, counters.by_name(), {}};
  accel::append_quality(*accelerator, scene, finding.statistics);
  for (std::size_t i = 0; i < input.size(); ++i) finding.hits += rays::is_hit_at(results, i);
  if (levels) finding.levels = rays::count_level_visits(*accelerator, input);
  return finding;
}

/// A table with a column for each structure.
struct StatisticsTable {
  explicit StatisticsTable(const std::vector<Finding>& all)
      : findings(all),
        table(row("", [](const Finding& finding) { return finding.choice.short_label(); })) {}

  template <class Show>
  std::vector<std::string> row(std::string name, Show show) const {
    std::vector<std::string> cells{std::move(name)};
    for (const Finding& finding : findings) cells.push_back(show(finding));
    return cells;
  }
  /// Adds a line: a name, and a function that shows the value for a structure.
  template <class Show>
  void add(std::string name, Show show) {
    table.add(row(std::move(name), show));
  }

  const std::vector<Finding>& findings;
  TextTable table;
};

std::string or_dash(std::uint64_t value) { return value == 0 ? "-" : fmt::format("{}", value); }

void add_sizes(StatisticsTable& table, const std::vector<Finding>& findings) {
  table.add("nodes", [](const Finding& f) { return or_dash(f.statistics.nodes); });
  table.add("leaves", [](const Finding& f) { return or_dash(f.statistics.leaves); });
  table.add("empty leaves", [](const Finding& f) { return or_dash(f.statistics.empty_leaves); });
  table.add("references", [](const Finding& f) { return or_dash(f.statistics.references); });
  table.add("depth", [](const Finding& f) { return or_dash(f.statistics.depth); });
  table.add("memory", [](const Finding& f) { return format_bytes(f.statistics.bytes); });
  table.add("instruction set", [](const Finding& f) {
    return f.statistics.instruction_set.empty() ? "-" : f.statistics.instruction_set;
  });
  table.add("build time (1)",
            [](const Finding& f) { return fmt::format("{:.3g} ms", f.build_ms); });

  std::set<std::string> extras;
  for (const Finding& finding : findings) {
    for (const auto& [name, value] : finding.statistics.more) extras.insert(name);
  }
  for (const std::string& extra : extras) {
    table.add(extra, [&](const Finding& f) -> std::string {
      for (const auto& [name, value] : f.statistics.more) {
        if (name == extra) return fmt::format("{:.6g}", value);
      }
      return "-";
    });
  }
}

void add_work(StatisticsTable& table, const std::vector<Finding>& findings, std::size_t rays) {
  table.add("rays that hit", [&](const Finding& f) { return format_share(f.hits, rays); });
  std::vector<std::string> names(accel::kCounterNames.begin(), accel::kCounterNames.end());
  for (const Finding& finding : findings) {
    for (const auto& [name, count] : finding.counters) {
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  for (const std::string& name : names) {
    table.add(name + " per ray", [&](const Finding& f) -> std::string {
      const auto found = f.counters.find(name);
      if (found == f.counters.end() || found->second == 0) return "-";
      return fmt::format("{:.4f}", static_cast<double>(found->second) / static_cast<double>(rays));
    });
  }
}

std::string levels_text(const Finding& finding) {
  TextTable table({"level", "nodes", "leaves", "occupied", "node visits", "leaf visits", "beams"},
                  0);
  for (const rays::LevelVisits& level : finding.levels) {
    table.add({fmt::format("{}", level.level), or_dash(level.nodes), or_dash(level.leaves),
               or_dash(level.occupied_leaves), or_dash(level.node_visits),
               or_dash(level.leaf_visits), or_dash(level.beams)});
  }
  return fmt::format(
      "\n{} by level (visits: rays that pass through a node, up to their first hit)\n{}",
      finding.choice.short_label(), table.text());
}

void print_text(const scenes::Scene& scene, const rays::ImageOfRays& image,
                const rays::TraceInput& input, const std::vector<Finding>& findings) {
  fmt::print("{}: {} primitives, {} {} rays ({}), coherence {:.3f}\n\n", scene.name,
             scene.primitives.size(), input.size(), input.label(),
             rays::to_string(image.resolution), rays::coherence(input));
  StatisticsTable table(findings);
  add_sizes(table, findings);
  add_work(table, findings, input.size());
  fmt::print("{}\n(1) of this single build, for information; 'beambench run' measures times\n",
             table.table.text());
  for (const Finding& finding : findings) {
    if (!finding.levels.empty()) fmt::print("{}", levels_text(finding));
  }
}

Json to_json(const Finding& finding, std::size_t rays) {
  const accel::Statistics& sizes = finding.statistics;
  const auto per_ray = [rays](std::uint64_t count) {
    return static_cast<double>(count) / static_cast<double>(rays);
  };
  Json out{{"structure", finding.choice.info().name},
           {"parameters", finding.choice.parameters().canonical()},
           {"nodes", sizes.nodes},
           {"leaves", sizes.leaves},
           {"empty_leaves", sizes.empty_leaves},
           {"references", sizes.references},
           {"depth", sizes.depth},
           {"memory_bytes", sizes.bytes},
           {"instruction_set", sizes.instruction_set},
           {"library_geometry", sizes.library_geometry},
           {"library_version", sizes.library_version},
           {"more", Json::object()},
           {"build_ms", finding.build_ms},
           {"hits", finding.hits},
           {"hit_share", per_ray(finding.hits)},
           {"per_ray", Json::object()}};
  for (const auto& [name, value] : sizes.more) out["more"][name] = value;
  for (const auto& [name, count] : finding.counters) out["per_ray"][name] = per_ray(count);
  for (const rays::LevelVisits& level : finding.levels) {
    out["levels"].push_back({{"level", level.level},
                             {"nodes", level.nodes},
                             {"leaves", level.leaves},
                             {"occupied_leaves", level.occupied_leaves},
                             {"node_visits", level.node_visits},
                             {"leaf_visits", level.leaf_visits},
                             {"beams", level.beams}});
  }
  return out;
}

void print_json(const scenes::Scene& scene, const rays::ImageOfRays& image,
                const rays::TraceInput& input, const std::vector<Finding>& findings) {
  Json out{{"scene", scene.name},
           {"primitives", scene.primitives.size()},
           {"width", image.resolution.width},
           {"height", image.resolution.height},
           {"ray_kind", input.label()},
           {"query", rays::to_string(input.query())},
           {"rays", input.size()},
           {"rays_hash", rays::hex_digits(rays::fingerprint(input))},
           {"coherence", rays::coherence(input)},
           {"structures", Json::array()}};
  for (const Finding& finding : findings) {
    out["structures"].push_back(to_json(finding, input.size()));
  }
  fmt::print("{}\n", json_text(out));
}

/// Shows the statistics. If a structure cannot be built over the scene, still shows the others.
int show_statistics(const StatsRequest& request) {
  const rays::Resolution resolution = rays::parse_resolution(request.resolution);
  const rays::RayChoice kind = rays::parse_ray_choice(request.rays);
  accel::registry().choose_list(
      request.structures);  // refuses an invalid name before generating the scene
  const scenes::Scene scene = open_scene(request.scene);
  rays::require_ray_count(resolution, 1);
  const rays::ImageOfRays image{choose_camera(scene, request.view), resolution, 1};
  const rays::TraceInput input = rays::make_trace_input(scene, image, kind);
  const Contenders contenders = choose_contenders(request.structures, scene);

  base::Progress progress(contenders.choices.size());
  if (!contenders.note.empty()) progress.say(contenders.note);
  std::vector<Finding> findings;
  bool all_built = true;
  for (const accel::StructureChoice& choice : contenders.choices) {
    progress.start(choice.info().name);
    try {
      findings.push_back(examine(choice, scene, image, input, request.levels));
      progress.finish(fmt::format("built in {:.3g} ms", findings.back().build_ms));
    } catch (const accel::UnsupportedError& error) {
      if (contenders.choices.size() == 1) throw;
      progress.finish(fmt::format("unsupported: {}", error.what()));
    } catch (const InputError& error) {
      if (contenders.choices.size() == 1) throw;
      all_built = false;
      progress.finish(fmt::format("not built: {}", error.what()));
    }
  }
  progress.clear();
  request.json ? print_json(scene, image, input, findings)
               : print_text(scene, image, input, findings);
  return all_built && !findings.empty() ? base::kSuccess : base::kInvalidInput;
}

}  // namespace

void add_stats_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("stats", "Print the sizes of structures and their work per ray");
  const auto request = std::make_shared<StatsRequest>();
  add_scene_option(*command, request->scene);
  command->add_option("--accel", request->structures, "Structures: NAME:parameter=value,... or all")
      ->required();
  command->add_option("--resolution", request->resolution, "WxH")->capture_default_str();
  command
      ->add_option("--rays", request->rays, "Kind of rays (see 'beambench list') or a .rays file")
      ->capture_default_str();
  add_view_options(*command, request->view);
  command->add_flag("--levels", request->levels,
                    "For octrees, also print the visits of rays and beams by level");
  command->add_flag("--json", request->json, "Print JSON instead of text");
  command->footer(
      "Examples:\n"
      "  beambench stats escena1 --accel all\n"
      "  beambench stats tetra:n=5 --accel samet:max_level=5,samet:max_level=7\n"
      "  beambench stats escena1 --accel all --rays shadow\n"
      "  beambench stats maceta --accel beam:max_level=8 --levels\n"
      "  beambench stats balls --accel samet --resolution 640x480 --json");
  command->callback([request, &exit_code] { exit_code = show_statistics(*request); });
}

}  // namespace beambench::cli
