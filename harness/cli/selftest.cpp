// beambench selftest: checks whether a structure fulfills its contract.

#include "harness/verify/selftest/selftest.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "harness/base/progress.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/inputs.hpp"
#include "harness/cli/text.hpp"
#include "harness/cli/verify_hits.hpp"
#include "harness/measure/record/machine.hpp"
#include "harness/plugin/isolated.hpp"
#include "harness/plugin/load_plugin.hpp"
#include "harness/verify/minimize.hpp"
#include "harness/verify/selftest/hit_comparison.hpp"
#include "harness/verify/selftest/kit.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/files.hpp"
#include "scenes/base/json_text.hpp"
#include "scenes/base/printable.hpp"
#include "scenes/base/shell_word.hpp"

namespace beambench::cli {
namespace {

struct SelftestRequest {
  std::string structures = "all";
  std::string json;
  verify::SelftestEffort effort;
  std::string minimize;  ///< folder; empty: do not reduce
  std::string kit;       ///< folder; empty: do not write one
  std::string primitives = "polygons";
  double timeout = kDefaultTimeout;
};

/// The result of one check of a structure.
struct CheckedProperty {
  std::string structure;
  const verify::Check* check;
  verify::CheckOutcome outcome;
  std::string case_folder{};  ///< the folder of its reduced wrong hit; empty: none
  std::string minimal{};      ///< text about it
};

std::string_view verdict_of(const verify::CheckOutcome& outcome) {
  return outcome.passed() ? "ok" : "failed";
}

std::string label_of(const verify::Subject& subject) { return subject.choice().short_label(); }

/// Reduces the wrong hits of a failed check.
void minimize_failure(const std::string& folder, CheckedProperty& property) {
  const verify::FailedInput& failed = *property.outcome.failed;
  const std::string name = fmt::format("{}-{}", property.structure, property.check->name);
  const std::string label = failed.structure.short_label();
  property.minimal = minimized_text(folder, name, failed.scene, failed.input, failed.wrong,
                                    verify::wrong_by_comparison(failed.structure), label,
                                    "--accel " + shell_quoted(label));
  const auto place = std::filesystem::path(folder) / file_stem(name);
  if (std::filesystem::exists(place)) property.case_folder = place.string();
}

/// Runs a check, in a child process for plug-ins.
CheckedProperty run_check(const verify::Check& check, const verify::Subject& subject,
                          const SelftestRequest& request) {
  CheckedProperty property{label_of(subject), &check, {}};
  const auto run = [&] {
    property.outcome = verify::run_check(check, subject, request.effort);
    if (property.outcome.failed && !request.minimize.empty()) {
      minimize_failure(request.minimize, property);
    }
    return json_text(nlohmann::json{property.outcome.rays, property.outcome.failure,
                                    property.case_folder, property.minimal},
                     -1);
  };
  try {
    const auto json = parse_json<nlohmann::json>(plugin::run_isolated(run, request.timeout), "");
    property.outcome.rays = json.at(0).get<std::uint64_t>();
    property.outcome.failure = json.at(1).get<std::string>();
    property.case_folder = json.at(2).get<std::string>();
    property.minimal = json.at(3).get<std::string>();
  } catch (const PluginError& error) {
    property.outcome.failure = error.what();
  }
  return property;
}

std::vector<CheckedProperty> check_all(const std::vector<verify::Subject>& subjects,
                                       const SelftestRequest& request) {
  base::Progress progress(subjects.size() * verify::selftest_checks().size());
  std::vector<CheckedProperty> checked;
  for (const verify::Subject& subject : subjects) {
    for (const verify::Check& check : verify::selftest_checks()) {
      if (!verify::applies(check, subject)) {
        progress.skip(1);
        continue;
      }
      progress.start(fmt::format("{}: {}", label_of(subject), check.name));
      checked.push_back(run_check(check, subject, request));
      progress.finish(std::string(verdict_of(checked.back().outcome)));
    }
  }
  progress.clear();
  return checked;
}

void print(const std::vector<CheckedProperty>& checked) {
  TextTable table({"structure", "check", "rays", "verdict"}, 2);
  for (const CheckedProperty& property : checked) {
    table.add({property.structure, std::string(property.check->name),
               fmt::format("{}", property.outcome.rays),
               std::string(verdict_of(property.outcome))});
  }
  fmt::print("{}", table.text());
  for (const CheckedProperty& property : checked) {
    if (property.outcome.passed()) continue;
    fmt::print("\n{}: {} ({}):\n  {}\n", property.structure, property.check->name,
               property.check->claim, property.outcome.failure);
    if (!property.minimal.empty()) fmt::print("  {}\n", property.minimal);
  }
}

/// Returns `, over polygons only: it does not support spheres and cones`; empty if all are
/// supported.
std::string limits_of(const verify::PrimitiveKinds& kinds) {
  if (kinds.all()) return "";
  return fmt::format(", over {} only: it does not support {}", fmt::join(kinds.names(), " and "),
                     fmt::join(kinds.without().names(), " and "));
}

void print_verdicts(const std::vector<CheckedProperty>& checked,
                    const std::vector<verify::Subject>& subjects) {
  fmt::print("\n");
  for (const verify::Subject& subject : subjects) {
    const std::string label = label_of(subject);
    const std::string limits = limits_of(subject.kinds());
    std::size_t made = 0;
    std::size_t failed = 0;
    for (const CheckedProperty& property : checked) {
      if (property.structure != label) continue;
      ++made;
      if (!property.outcome.passed()) ++failed;
    }
    if (made == 0) {
      fmt::print("{}: finds no hits by design, so there is nothing to check\n", label);
    } else if (failed == 0) {
      fmt::print("{}: ok, passes all {} checks{}\n", label, made, limits);
    } else {
      fmt::print("{}: failed {} of {} checks{}\n", label, failed, made, limits);
    }
  }
}

/// Prints how to verify the kit, which has more scenes than these checks.
void print_next_step(const SelftestRequest& request) {
  if (request.structures == "all") return;
  const std::string program = plugin::program_call_here();
  fmt::print(
      "\nNext, the conformance kit, which has more scenes and allows no leaks in closed meshes:\n"
      "  {} selftest --export kit\n  {} verify --kit kit --accel {}\n",
      program, program, shell_quoted(request.structures));
}

void write_json(const SelftestRequest& request, const std::vector<CheckedProperty>& checked,
                const std::vector<verify::Subject>& subjects, bool passed) {
  nlohmann::ordered_json out{{"beambench", measure::build_info().version},
                             {"seed", request.effort.seed},
                             {"scenes", request.effort.scenes},
                             {"rays", request.effort.rays},
                             {"passed", passed},
                             {"structures", nlohmann::ordered_json::array()},
                             {"checks", nlohmann::ordered_json::array()}};
  for (const verify::Subject& subject : subjects) {
    out["structures"].push_back(
        {{"structure", label_of(subject)}, {"primitives", subject.kinds().names()}});
  }
  for (const CheckedProperty& property : checked) {
    out["checks"].push_back({{"structure", property.structure},
                             {"check", property.check->name},
                             {"claim", property.check->claim},
                             {"rays", property.outcome.rays},
                             {"passed", property.outcome.passed()},
                             {"failure", property.outcome.failure},
                             {"case", property.case_folder}});
  }
  write_file(request.json, json_text(out) + '\n');
}

/// Parses `spheres,polygons` or `all`. Throws InputError listing the kinds.
verify::PrimitiveKinds parse_kinds(const std::string& list) {
  if (list == "all") return {};
  constexpr std::array<std::string_view, 3> kNames{"spheres", "cones", "polygons"};
  verify::PrimitiveKinds kinds = verify::PrimitiveKinds{}.without();
  for (const std::string& name : CLI::detail::split(list, ',')) {
    const std::size_t place = base::place_of_name("kind of primitives", name, kNames);
    (place == 0 ? kinds.spheres : place == 1 ? kinds.cones : kinds.polygons) = true;
  }
  return kinds;
}

int write_kit(const SelftestRequest& request) {
  const verify::PrimitiveKinds kinds = parse_kinds(request.primitives);
  base::Progress progress(verify::kit_size(request.effort, kinds));
  const std::size_t scenes = verify::write_kit(request.kit, request.effort, kinds, progress);
  progress.clear();
  fmt::print("{}: {} scenes of {}, each with closest-hit and any-hit queries\n",
             printable(request.kit), scenes, fmt::join(kinds.names(), ", "));
  return base::kSuccess;
}

int selftest(const SelftestRequest& request) {
  if (!request.kit.empty()) return write_kit(request);
  if (!request.json.empty()) require_writable(request.json);
  std::vector<verify::Subject> subjects;
  for (accel::StructureChoice& choice : accel::registry().choose_list(request.structures)) {
    const std::string kinds = plugin::run_isolated(
        [&] { return fmt::format("{}", fmt::join(verify::kinds_taken(choice).names(), ",")); },
        request.timeout);
    subjects.emplace_back(std::move(choice), parse_kinds(kinds));
  }
  const std::vector<CheckedProperty> checked = check_all(subjects, request);
  const bool passed = std::ranges::all_of(
      checked, [](const CheckedProperty& property) { return property.outcome.passed(); });
  print(checked);
  print_verdicts(checked, subjects);
  print_next_step(request);
  if (!request.json.empty()) write_json(request, checked, subjects, passed);
  return passed ? base::kSuccess : base::kMismatch;
}

}  // namespace

void add_selftest_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("selftest", "Check a structure's contract over scenes made to break it");
  const auto request = std::make_shared<SelftestRequest>();
  CLI::Option* accel = command
                           ->add_option("--accel", request->structures,
                                        "Structures: NAME:parameter=value,... or all")
                           ->capture_default_str();
  command
      ->add_option("--scenes", request->effort.scenes,
                   "Number of random scenes for each check that uses them")
      ->check(whole_number_in(1, 100'000))
      ->capture_default_str();
  command->add_option("--seed", request->effort.seed, "Seed of the first random scene")
      ->capture_default_str();
  command
      ->add_option("--rays", request->effort.rays,
                   "Approximate number of rays for each random scene; more rays find rarer errors")
      ->check(whole_number_in(20, 1'000'000))
      ->capture_default_str();
  CLI::Option* minimize =
      command
          ->add_option("--minimize", request->minimize,
                       "Reduce each wrong hit to the fewest primitives and one ray, and write them "
                       "to this folder")
          ->type_name("DIR");
  add_timeout_option(*command, request->timeout);
  CLI::Option* json =
      command->add_option("--json", request->json, "Also write the results to this file");
  CLI::Option* kit = command
                         ->add_option("--export", request->kit,
                                      "Write the scenes and rays to this folder instead, for "
                                      "'beambench verify --kit'")
                         ->type_name("DIR");
  command
      ->add_option(
          "--primitives", request->primitives,
          "Kinds of primitives in the scenes of --export: spheres, cones, polygons, or all")
      ->capture_default_str()
      ->needs(kit);
  for (CLI::Option* option : {accel, json, minimize}) kit->excludes(option);
  command->footer(
      "Hits must equal those of exhaustive search, bit for bit; hits of a structure with its own\n"
      "arithmetic are judged by the differ's classes. A structure without parameters after its "
      "name\n"
      "gets random ones in the random scenes; one that does not support a kind of primitives is\n"
      "checked over the others. Exits with 1 if a check failed.\n"
      "Examples:\n"
      "  beambench selftest --accel samet --scenes 10\n"
      "  beambench selftest --accel samet:max_level=4,voxel-grid --scenes 5 --json selftest.json\n"
      "  beambench selftest --export kit --scenes 20");
  command->callback([request, &exit_code] { exit_code = selftest(*request); });
}

}  // namespace beambench::cli
