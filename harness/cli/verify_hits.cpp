#include "harness/cli/verify_hits.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/cli/text.hpp"
#include "harness/measure/record/machine.hpp"
#include "harness/plugin/isolated.hpp"
#include "harness/plugin/load_plugin.hpp"
#include "harness/rays/ray_file.hpp"
#include "harness/render/diagnostics.hpp"
#include "harness/verify/describe.hpp"
#include "harness/verify/hit_files.hpp"
#include "harness/verify/outside_program.hpp"
#include "harness/verify/selftest/kit.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/files.hpp"
#include "scenes/base/json_text.hpp"
#include "scenes/base/printable.hpp"
#include "scenes/base/shell_word.hpp"

namespace beambench::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kPrinted = 3;  // number of examples; the JSON has all

/// The findings for one ray file.
struct VerifiedClaims {
  std::string name;    ///< of the case
  std::string family;  ///< of a kit
  std::string scene;
  std::string replay{};  ///< the command that verifies it again
  std::size_t primitives = 0;
  rays::Query query = rays::Query::kClosestHit;
  verify::Verdict verdict = verify::Verdict::kError;
  verify::DiffReport report{};  ///< without its examples; empty if nothing was verified
  Json examples = Json::array();
  std::string disputes{};  ///< descriptions of the first faults
  std::string message{};   ///< why nothing was verified; empty otherwise
  std::string picture{};   ///< the picture's file; empty: none
  std::string minimal{};   ///< text about the reduction; empty: none

  bool passed() const { return verify::is_right(verdict); }
  bool was_possible() const { return verdict != verify::Verdict::kUnsupported; }
  std::uint64_t count(verify::DiffClass diff_class) const {
    // A leak has a column of its own.
    return report.count(diff_class) - (diff_class == verify::DiffClass::kGraze ? report.leaks : 0);
  }
};

/// Returns whether a mismatch is a dispute. Ties are not disputes; grazes are disputes only if
/// there are too many.
bool is_dispute(const verify::Mismatch& mismatch, verify::Verdict verdict) {
  if (mismatch.is_fault()) return true;
  return mismatch.diff_class == verify::DiffClass::kOracleError ||
         (mismatch.diff_class == verify::DiffClass::kGraze && verdict == verify::Verdict::kGrazes);
}

std::string describe_disputes(const verify::ClaimsReport& found, const scenes::Scene& scene) {
  std::string text;
  std::size_t disputes = 0;
  for (std::size_t i = 0; i < found.report.examples.size(); ++i) {
    const verify::Mismatch& each = found.report.examples[i];
    if (!is_dispute(each, found.report.verdict) || ++disputes > kPrinted) continue;
    text += '\n' + verify::describe(scene, found.places[i], each, "reported");
  }
  if (disputes > kPrinted) {
    text += fmt::format("\n... and {} more, which --json FILE writes\n", disputes - kPrinted);
  }
  return text;
}

std::string table_text(std::span<const VerifiedClaims> all, const std::string& first_column) {
  std::vector<std::string> header{first_column, "query", "rays", "hits"};
  for (const char* name :
       {"agree", "tie", "graze", "structure error", "oracle error", "leak", "verdict"}) {
    header.emplace_back(name);
  }
  TextTable table(std::move(header), 2);
  for (const VerifiedClaims& each : all) {
    const verify::DiffReport& report = each.report;
    std::vector<std::string> row{each.name, std::string(rays::to_string(each.query)),
                                 fmt::format("{}", report.rays), fmt::format("{}", report.hits)};
    for (std::size_t i = 0; i < report.counts.size(); ++i) {
      row.push_back(fmt::format("{}", each.count(static_cast<verify::DiffClass>(i))));
    }
    row.push_back(fmt::format("{}", report.leaks));
    row.emplace_back(verify::to_string(each.verdict));
    table.add(std::move(row));
  }
  return table.text();
}

/// The sums over the cases of one family and query.
struct FamilyRow {
  std::string family;
  rays::Query query;
  std::size_t cases = 0;
  std::size_t right = 0;
  std::uint64_t rays = 0;
  std::uint64_t leaks = 0;
  std::array<std::uint64_t, verify::kDiffClassNames.size()> counts{};
  verify::Verdict verdict = verify::Verdict::kUnsupported;  ///< the worst

  void add(const VerifiedClaims& claims) {
    ++cases;
    leaks += claims.report.leaks;
    rays += claims.report.rays;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      counts[i] += claims.count(static_cast<verify::DiffClass>(i));
    }
    if (!claims.was_possible()) return;
    if (claims.passed()) ++right;
    if (failed()) return;
    verdict = claims.verdict;
  }
  bool failed() const {
    return !verify::is_right(verdict) && verdict != verify::Verdict::kUnsupported;
  }
  std::uint64_t count(verify::DiffClass diff_class) const {
    return counts[static_cast<std::size_t>(diff_class)];
  }
};

/// Returns the rows in the order of the kit, with failed rows at the end.
std::vector<FamilyRow> rows_by_family(std::span<const VerifiedClaims> all) {
  std::vector<FamilyRow> rows;
  for (const VerifiedClaims& each : all) {
    auto row = std::ranges::find_if(rows, [&](const FamilyRow& known) {
      return known.family == each.family && known.query == each.query;
    });
    if (row == rows.end()) row = rows.insert(row, {each.family, each.query});
    row->add(each);
  }
  std::ranges::stable_partition(rows, [](const FamilyRow& row) { return !row.failed(); });
  return rows;
}

std::string family_table(std::span<const VerifiedClaims> all) {
  TextTable table({"family", "query", "cases", "right", "rays", "agree or tie", "graze", "wrong",
                   "leaks", "oracle error", "verdict"},
                  2);
  using verify::DiffClass;
  for (const FamilyRow& row : rows_by_family(all)) {
    table.add({row.family, std::string(rays::to_string(row.query)), fmt::format("{}", row.cases),
               fmt::format("{}", row.right), fmt::format("{}", row.rays),
               fmt::format("{}", row.count(DiffClass::kAgree) + row.count(DiffClass::kTie)),
               fmt::format("{}", row.count(DiffClass::kGraze)),
               fmt::format("{}", row.count(DiffClass::kStructureError)),
               fmt::format("{}", row.leaks), fmt::format("{}", row.count(DiffClass::kOracleError)),
               std::string(verify::to_string(row.verdict))});
  }
  return table.text();
}

bool has_oracle_errors(const VerifiedClaims& claims) {
  return claims.report.count(verify::DiffClass::kOracleError) > 0;
}

void print_findings(const VerifiedClaims& claims) {
  if (!claims.message.empty()) fmt::print("\n{}\n", claims.message);
  fmt::print("{}", claims.disputes);
  if (!claims.minimal.empty()) fmt::print("\n{}\n", claims.minimal);
  if (!claims.picture.empty()) fmt::print("\npicture: {}\n", claims.picture);
}

Json json_of(const VerifiedClaims& claims) {
  const verify::DiffReport& report = claims.report;
  Json out{{"name", claims.name},
           {"family", claims.family},
           {"scene", claims.scene},
           {"primitives", claims.primitives},
           {"query", rays::to_string(claims.query)},
           {"verdict", verify::to_string(claims.verdict)},
           {"message", claims.message},
           {"passed", claims.passed()},
           {"replay", claims.replay},
           {"rays", report.rays},
           {"hits", report.hits},
           {"leaks", report.leaks}};
  for (std::size_t i = 0; i < verify::kRecordedClassNames.size(); ++i) {
    out[std::string(verify::kRecordedClassNames[i])] = report.counts[i];
  }
  out["examples"] = claims.examples;
  if (!claims.picture.empty()) out["picture"] = claims.picture;
  if (!claims.minimal.empty()) out["minimal"] = claims.minimal;
  return out;
}

/// Packs the findings in a child process, for `unpack` in its parent.
std::string pack(const VerifiedClaims& claims) {
  const verify::DiffReport& report = claims.report;
  return json_text(Json{claims.scene, claims.primitives, claims.query, claims.verdict, report.rays,
                        report.hits, report.counts, report.leaks, claims.examples, claims.disputes,
                        claims.message, claims.picture, claims.minimal},
                   -1);
}

void unpack(const std::string& text, VerifiedClaims& claims) {
  verify::DiffReport& report = claims.report;
  const Json json = parse_json<Json>(text, "a case's findings");
  std::size_t place = 0;
  const auto take = [&](auto& value) { json.at(place++).get_to(value); };
  take(claims.scene), take(claims.primitives), take(claims.query), take(claims.verdict);
  take(report.rays), take(report.hits), take(report.counts), take(report.leaks);
  take(claims.examples), take(claims.disputes), take(claims.message), take(claims.picture);
  take(claims.minimal);
}

/// Returns whether hits were verified and all of them are correct.
bool passed(std::span<const VerifiedClaims> all) {
  return std::ranges::any_of(all, &VerifiedClaims::was_possible) &&
         std::ranges::all_of(all, [](const VerifiedClaims& claims) {
           return claims.passed() || !claims.was_possible();
         });
}

void write_json(const VerifyHitsRequest& request, std::span<const VerifiedClaims> all) {
  Json out{{"beambench", measure::build_info().version},
           {"passed", passed(all)},
           {"cases", Json::array()}};
  for (const VerifiedClaims& each : all) out["cases"].push_back(json_of(each));
  write_file(request.json, json_text(out) + '\n');
}

/// Returns the source of the hits, unless they are in a file.
std::optional<verify::Tracer> tracer_of(const VerifyHitsRequest& request) {
  if (!request.command.empty()) return verify::program_of(request.command);
  if (request.structure) return verify::tracer_of(*request.structure);
  return std::nullopt;
}

std::string subject_of(const VerifyHitsRequest& request, const std::string& hits) {
  if (!request.command.empty()) return printable(request.command);
  return request.structure ? request.structure->short_label() : printable(hits);
}

/// Returns the option that names the source of the hits, for a command.
std::string option_of(const VerifyHitsRequest& request, const std::string& hits) {
  if (!request.command.empty()) return "--command " + shell_quoted(request.command);
  if (request.structure) return "--accel " + shell_quoted(request.structure->short_label());
  return "--hits " + shell_quoted(hits);
}

VerifiedClaims claims_of(const VerifyHitsRequest& request, const verify::KitCase& files) {
  return {
      .name = printable(files.name),
      .family = files.family,
      .scene = files.scene.string(),
      .replay = fmt::format("{} verify {} --rays {} {}", plugin::program_call_here(),
                            shell_quoted(files.scene.string()), shell_quoted(files.rays.string()),
                            option_of(request, files.hits.string())),
      .query = files.query};
}

/// Verifies a case, and fills in the rest of `claims`.
void verify_case(const VerifyHitsRequest& request, const scenes::Scene& scene,
                 const verify::KitCase& files, const std::optional<verify::Tracer>& tracer,
                 base::Progress& progress, VerifiedClaims& claims) {
  claims.scene = scene.name;
  claims.primitives = scene.primitives.size();
  render::DisputedPlaces places;
  const auto collect = [&](const verify::Mismatch& mismatch) { places.add(mismatch); };
  const verify::ClaimsReport found =
      tracer ? verify::verify_traced_file(scene, files.rays, *tracer, collect, files.closed)
             : verify::verify_hit_files(scene, files.rays, files.hits, collect, progress,
                                        files.closed);
  const verify::DiffReport& report = found.report;
  claims.query = found.query;
  claims.verdict = report.verdict;
  claims.report = report;
  claims.report.examples.clear();
  for (std::size_t i = 0; i < report.examples.size(); ++i) {
    claims.examples.push_back(to_json(report.examples[i]));
    claims.examples.back()["place"] = found.places[i];
  }
  claims.disputes = describe_disputes(found, scene);
  if (!request.pictures.empty() && !places.empty()) {
    const rays::ImageOfRays image{choose_camera(scene, request.view),
                                  rays::parse_resolution(request.resolution), 1};
    const auto file = std::filesystem::path(request.pictures) /
                      picture_name(fmt::format("{}-{}", files.name, image.camera.name));
    render::write_disputed_places(file, scene, image.rays(), places);
    claims.picture = file.string();
  }
  if (request.minimize.empty() || report.faults() == 0) return;
  const std::string subject = subject_of(request, files.hits.string());
  if (tracer) {
    rays::RaySet set = rays::read_ray_file(files.rays);
    set.must_hit |= files.closed;
    claims.minimal = minimized_text(
        request.minimize, files.name, scene, rays::TraceInput(std::move(set)),
        report.examples.front(), verify::wrong_by_differ(*tracer), subject, option_of(request, ""));
  } else {
    const auto folder = std::filesystem::path(request.minimize) / file_stem(files.name);
    const verify::MinimalCase minimal = verify::named_case(scene, report.examples.front());
    verify::write_case(folder, minimal, scene.name, subject);
    claims.minimal = case_text(folder, minimal, "");
  }
}

/// Verifies a case of a kit: a case that the tracer declines is unsupported, and a case in which it
/// fails is an error.
VerifiedClaims verify_kit_case(const VerifyHitsRequest& request, const verify::KitCase& files,
                               const std::optional<verify::Tracer>& tracer,
                               base::Progress& progress) {
  VerifiedClaims claims = claims_of(request, files);
  const auto verify_it = [&] {
    const scenes::Scene scene = open_scene(files.scene.string());
    verify_case(request, scene, files, tracer, progress, claims);
  };
  const auto without_hits = [&](verify::Verdict verdict, const std::exception& error) {
    claims.verdict = verdict;
    claims.message = error.what();
  };
  if (!tracer) {
    verify_it();
    return claims;
  }
  try {
    if (request.structure && plugin::must_isolate()) {
      const auto verified = [&] {
        verify_it();
        return pack(claims);
      };
      unpack(plugin::run_isolated(verified, request.timeout), claims);
    } else {
      verify_it();
    }
  } catch (const accel::UnsupportedError& error) {
    without_hits(verify::Verdict::kUnsupported, error);
  } catch (const InputError& error) {
    without_hits(verify::Verdict::kError, error);
  } catch (const PluginError& error) {
    without_hits(verify::Verdict::kError, error);
  }
  return claims;
}

/// Returns the verdict and the faults, for the progress line.
std::string result_of(const VerifiedClaims& claims) {
  std::string text(verify::to_string(claims.verdict));
  if (claims.report.leaks > 0) text += ", " + base::counted(claims.report.leaks, "leak");
  if (!claims.message.empty()) text += ": " + claims.message;
  return text;
}

void require_outputs(const VerifyHitsRequest& request) {
  if (!request.json.empty()) require_writable(request.json);
  if (!request.pictures.empty()) make_folder(request.pictures, "choose another with --pictures");
}

}  // namespace

void print_oracle_note(bool any) {
  if (!any) return;
  fmt::print(
      "\n"
      "oracle error: by exact arithmetic over all primitives, the program is right and the\n"
      "oracle, Embree with exact intersectors, is wrong. Such rays count as right.\n");
}

std::string case_text(const std::filesystem::path& folder, const verify::MinimalCase& minimal,
                      const std::string& option) {
  std::string text = fmt::format(
      "reduced to {} and {}, in {}{}", base::counted(minimal.primitives.size(), "primitive"),
      base::counted(minimal.input.size(), "ray"), printable(folder.string()),
      minimal.repeated ? ""
                       : ": the primitives named in the hits; with --command, the ray is "
                         "traced again, which shows whether they are enough");
  if (option.empty()) return text;
  const accel::PrimaryRays* image = minimal.input.image();
  const std::string rays = image == nullptr
                               ? "--rays " + shell_quoted((folder / "ray.rays").string())
                               : fmt::format("--resolution {}x{} --samples {}", image->width(),
                                             image->height(), image->samples());
  return fmt::format("{}\nreplay: {} verify {} {} {}", text, plugin::program_call_here(),
                     shell_quoted((folder / "scene.nff").string()), rays, option);
}

std::string minimized_text(const std::string& folder, const std::string& name,
                           const scenes::Scene& scene, const rays::TraceInput& input,
                           const verify::Mismatch& wrong, const verify::FindWrong& find_wrong,
                           const std::string& subject, const std::string& option,
                           const scenes::Camera* camera) {
  base::Progress progress(1);
  auto minimal = verify::minimize(scene, input, wrong, find_wrong, progress);
  progress.clear();
  if (!minimal) return "not reduced: the fault is gone when the same rays are traced again";
  if (camera != nullptr) minimal->scene.cameras = {*camera};
  const auto place = std::filesystem::path(folder) / file_stem(name);
  verify::write_case(place, *minimal, scene.name, subject);
  return case_text(place, *minimal, option);
}

int verify_hits(const VerifyHitsRequest& request) {
  require_outputs(request);
  const auto tracer = tracer_of(request);
  const scenes::Scene scene = open_scene(request.scene);
  choose_camera(scene, request.view);
  const std::filesystem::path file = request.hits.empty() ? request.rays : request.hits;
  const verify::KitCase files{.name = file.filename().string(),
                              .scene = request.scene,
                              .rays = request.rays,
                              .hits = request.hits};
  VerifiedClaims claims = claims_of(request, files);
  base::Progress progress(1);
  progress.start(fmt::format("{} over {}", printable(file.string()), scene.name));
  verify_case(request, scene, files, tracer, progress, claims);
  progress.finish(result_of(claims));
  progress.clear();
  fmt::print("{} over {}\n\n{}", subject_of(request, request.hits), scene.name,
             table_text({&claims, 1}, "file"));
  print_oracle_note(has_oracle_errors(claims));
  print_findings(claims);
  if (!request.json.empty()) write_json(request, {&claims, 1});
  return claims.passed() ? base::kSuccess : base::kMismatch;
}

int verify_kit(const VerifyHitsRequest& request) {
  require_outputs(request);
  const auto tracer = tracer_of(request);
  const std::vector<verify::KitCase> cases = verify::read_kit(request.kit);
  if (!tracer) {
    for (const verify::KitCase& each : cases) {
      if (std::filesystem::exists(each.hits)) continue;
      throw InputError(fmt::format(
          "{}: there are no hits beside the rays; trace {} and write them, or use --command",
          each.hits.string(), each.rays.string()));
    }
  }
  base::Progress progress(cases.size());
  std::vector<VerifiedClaims> all;
  std::size_t failed = 0;
  for (const verify::KitCase& each : cases) {
    progress.start(printable(each.name));
    all.push_back(verify_kit_case(request, each, tracer, progress));
    const VerifiedClaims& claims = all.back();
    progress.finish(result_of(claims));
    if (claims.passed() || !claims.was_possible()) continue;
    progress.clear();
    if (++failed <= kPrinted) {
      fmt::print("{}:\n", claims.name);
      print_findings(claims);
      fmt::print("\nreplay: {}\n\n", claims.replay);
    } else {
      fmt::print("{}: {}\nreplay: {}\n\n", claims.name, result_of(claims), claims.replay);
    }
  }
  progress.clear();
  const auto supported =
      static_cast<std::size_t>(std::ranges::count_if(all, &VerifiedClaims::was_possible));
  fmt::print("{}", family_table(all));
  print_oracle_note(std::ranges::any_of(all, has_oracle_errors));
  fmt::print(
      "\n{}: {} of {} cases right{}\n", subject_of(request, request.kit), supported - failed,
      supported,
      supported == all.size() ? "" : fmt::format(", {} unsupported", all.size() - supported));
  if (!request.json.empty()) write_json(request, all);
  if (supported == 0) {
    throw InputError(
        fmt::format("nothing was verified: {}", all.empty() ? "no cases" : all.front().message));
  }
  return failed == 0 ? base::kSuccess : base::kMismatch;
}

}  // namespace beambench::cli
