#include "harness/cli/verify_hits.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/cli/text.hpp"
#include "harness/measure/record/machine.hpp"
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

namespace beambench::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kPrinted = 3;  // number of examples; the JSON has all

/// The findings for one file of rays.
struct VerifiedClaims {
  std::string name;    ///< of the case
  std::string family;  ///< of a kit
  std::string scene;
  std::size_t primitives = 0;
  verify::ClaimsReport found{};  ///< empty if nothing was verified
  verify::Verdict verdict = verify::Verdict::kError;
  /// Rays that left a closed surface between two triangles; the differ alone calls them grazes.
  std::uint64_t leaks = 0;
  std::string message{};  ///< why nothing was verified; empty otherwise
  std::string picture{};  ///< the picture's file; empty: none
  std::string minimal{};  ///< a line about the reduction; empty: none

  bool passed() const { return verify::is_right(verdict); }
  bool was_possible() const { return verdict != verify::Verdict::kUnsupported; }
};

/// Returns whether the program reports that the ray hits nothing.
bool is_miss(const verify::Mismatch& mismatch) {
  return mismatch.query == rays::Query::kClosestHit ? !mismatch.answer
                                                    : mismatch.any_hit_answer == 0;
}

/// Returns whether a mismatch is a dispute. Ties are not, and grazes only if there are too many.
bool is_dispute(const verify::Mismatch& mismatch, verify::Verdict verdict) {
  if (mismatch.diff_class == verify::DiffClass::kTie) return false;
  return mismatch.diff_class != verify::DiffClass::kGraze || verdict == verify::Verdict::kGrazes;
}

std::string table_text(std::span<const VerifiedClaims> all, const std::string& first_column) {
  std::vector<std::string> header{first_column, "query", "rays", "hits"};
  for (const char* name : {"agree", "tie", "graze", "structure error", "oracle error", "verdict"}) {
    header.emplace_back(name);
  }
  TextTable table(std::move(header), 2);
  for (const VerifiedClaims& each : all) {
    const verify::DiffReport& report = each.found.report;
    std::vector<std::string> row{each.name, std::string(rays::to_string(each.found.query)),
                                 fmt::format("{}", report.rays), fmt::format("{}", report.hits)};
    for (const std::uint64_t count : report.counts) row.push_back(fmt::format("{}", count));
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
    leaks += claims.leaks;
    rays += claims.found.report.rays;
    for (std::size_t i = 0; i < counts.size(); ++i) counts[i] += claims.found.report.counts[i];
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

/// Returns the rows in the order of the kit, with those that failed last.
std::vector<FamilyRow> rows_by_family(std::span<const VerifiedClaims> all) {
  std::vector<FamilyRow> rows;
  for (const VerifiedClaims& each : all) {
    auto row = std::ranges::find_if(rows, [&](const FamilyRow& known) {
      return known.family == each.family && known.query == each.found.query;
    });
    if (row == rows.end()) row = rows.insert(row, {each.family, each.found.query});
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
  return claims.found.report.count(verify::DiffClass::kOracleError) > 0;
}

void print_disputes(const VerifiedClaims& claims, const scenes::Scene& scene) {
  const verify::DiffReport& report = claims.found.report;
  if (!claims.message.empty()) fmt::print("\n{}\n", claims.message);
  std::size_t disputes = 0;
  for (std::size_t i = 0; i < report.examples.size(); ++i) {
    const verify::Verdict verdict = claims.leaks > 0 ? verify::Verdict::kGrazes : report.verdict;
    if (!is_dispute(report.examples[i], verdict)) continue;
    if (++disputes > kPrinted) continue;
    fmt::print("\n{}",
               verify::describe(scene, claims.found.places[i], report.examples[i], "reported"));
  }
  if (disputes > kPrinted) {
    fmt::print("\n... and {} more, which --json FILE writes\n", disputes - kPrinted);
  }
  if (!claims.minimal.empty()) fmt::print("\n{}\n", claims.minimal);
  if (!claims.picture.empty()) fmt::print("\npicture: {}\n", claims.picture);
}

Json json_of(const VerifiedClaims& claims) {
  const verify::DiffReport& report = claims.found.report;
  Json out{{"name", claims.name},
           {"family", claims.family},
           {"scene", claims.scene},
           {"primitives", claims.primitives},
           {"query", rays::to_string(claims.found.query)},
           {"verdict", verify::to_string(claims.verdict)},
           {"message", claims.message},
           {"passed", claims.passed()},
           {"rays", report.rays},
           {"hits", report.hits},
           {"leaks", claims.leaks}};
  for (std::size_t i = 0; i < verify::kRecordedClassNames.size(); ++i) {
    out[std::string(verify::kRecordedClassNames[i])] = report.counts[i];
  }
  out["examples"] = Json::array();
  for (std::size_t i = 0; i < report.examples.size(); ++i) {
    Json example = to_json(report.examples[i]);
    example["place"] = claims.found.places[i];
    out["examples"].push_back(std::move(example));
  }
  if (!claims.picture.empty()) out["picture"] = claims.picture;
  if (!claims.minimal.empty()) out["minimal"] = claims.minimal;
  return out;
}

/// Returns whether hits were verified, and all of them are right.
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

VerifiedClaims verify_case(const VerifyHitsRequest& request, const scenes::Scene& scene,
                           const verify::KitCase& files,
                           const std::optional<verify::Tracer>& tracer, base::Progress& progress) {
  render::DisputedPlaces places;
  std::uint64_t grazed_misses = 0;
  const auto collect = [&](const verify::Mismatch& mismatch) {
    places.add(mismatch);
    if (mismatch.diff_class == verify::DiffClass::kGraze && is_miss(mismatch)) ++grazed_misses;
  };
  VerifiedClaims claims{printable(files.name), files.family, scene.name, scene.primitives.size()};
  claims.found = tracer
                     ? verify::verify_traced_file(scene, files.rays, *tracer, collect, progress)
                     : verify::verify_hit_files(scene, files.rays, files.hits, collect, progress);
  const verify::DiffReport& report = claims.found.report;
  claims.verdict = report.verdict;
  if (files.closed && grazed_misses > 0) {
    claims.leaks = grazed_misses;
    claims.verdict = verify::Verdict::kMismatch;
  }
  if (!request.pictures.empty() && !places.empty()) {
    const rays::ImageOfRays image{choose_camera(scene, request.view),
                                  rays::parse_resolution(request.resolution), 1};
    const auto file = std::filesystem::path(request.pictures) /
                      picture_name(fmt::format("{}-{}", files.name, image.camera.name));
    render::write_disputed_places(file, scene, image.rays(), places);
    claims.picture = file.string();
  }
  if (!request.minimize.empty() && report.count(verify::DiffClass::kStructureError) > 0) {
    const std::string subject = subject_of(request, files.hits.string());
    if (tracer) {
      claims.minimal = minimized_text(request.minimize, files.name, scene,
                                      rays::TraceInput(rays::read_ray_file(files.rays)), report,
                                      *tracer, subject, progress);
    } else {
      const auto folder = std::filesystem::path(request.minimize) / file_stem(files.name);
      const verify::MinimalCase minimal = verify::named_case(scene, report.examples.front());
      verify::write_case(folder, minimal, scene.name, subject);
      claims.minimal = case_text(folder, minimal);
    }
  }
  return claims;
}

/// Verifies a case of a kit. If the tracer declines it, the case is unsupported; if the tracer
/// fails, it is an error. Throws if the very first case fails, because then the command or the
/// structure is at fault.
VerifiedClaims verify_kit_case(const VerifyHitsRequest& request, const verify::KitCase& files,
                               const std::optional<verify::Tracer>& tracer, bool is_first,
                               base::Progress& progress) {
  const scenes::Scene scene = open_scene(files.scene.string());
  if (!tracer) return verify_case(request, scene, files, tracer, progress);
  const auto without_hits = [&](verify::Verdict verdict, const std::exception& error) {
    VerifiedClaims claims{printable(files.name), files.family, scene.name, scene.primitives.size()};
    claims.found.query = files.query;
    claims.verdict = verdict;
    claims.message = error.what();
    progress.finish(fmt::format("{}: {}", verify::to_string(verdict), claims.message));
    return claims;
  };
  try {
    return verify_case(request, scene, files, tracer, progress);
  } catch (const accel::UnsupportedError& error) {
    return without_hits(verify::Verdict::kUnsupported, error);
  } catch (const InputError& error) {
    if (is_first) throw;
    return without_hits(verify::Verdict::kError, error);
  } catch (const PluginError& error) {
    return without_hits(verify::Verdict::kError, error);
  }
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
      "oracle error: by exact arithmetic over all primitives, the program is right there, and the\n"
      "oracle, Embree with exact intersectors, is wrong. Such rays count as right.\n");
}

std::string case_text(const std::filesystem::path& folder, const verify::MinimalCase& minimal) {
  return fmt::format("reduced to {} and {}, in {}{}",
                     base::counted(minimal.primitives.size(), "primitive"),
                     base::counted(minimal.input.size(), "ray"), printable(folder.string()),
                     minimal.repeated ? ""
                                      : ": those that the hits name; with --command they are "
                                        "traced again, which shows whether these are enough");
}

std::string minimized_text(const std::string& folder, const std::string& name,
                           const scenes::Scene& scene, const rays::TraceInput& input,
                           const verify::DiffReport& report, const verify::Tracer& tracer,
                           const std::string& subject, base::Progress& progress) {
  const auto minimal = verify::minimize(scene, input, report.examples.front(),
                                        verify::wrong_by_differ(tracer), progress);
  if (!minimal) return "not reduced: the hit is right when the same rays are traced again";
  const auto place = std::filesystem::path(folder) / file_stem(name);
  verify::write_case(place, *minimal, scene.name, subject);
  return case_text(place, *minimal);
}

int verify_hits(const VerifyHitsRequest& request) {
  require_outputs(request);
  const auto tracer = tracer_of(request);
  const scenes::Scene scene = open_scene(request.scene);
  choose_camera(scene, request.view);
  base::Progress progress(request.minimize.empty() ? 1 : 2);
  const std::filesystem::path file = request.hits.empty() ? request.rays : request.hits;
  const VerifiedClaims claims = verify_case(request, scene,
                                            {.name = file.filename().string(),
                                             .scene = request.scene,
                                             .rays = request.rays,
                                             .hits = request.hits},
                                            tracer, progress);
  progress.clear();
  fmt::print("{} over {}\n\n{}", subject_of(request, request.hits), scene.name,
             table_text({&claims, 1}, "file"));
  print_oracle_note(has_oracle_errors(claims));
  print_disputes(claims, scene);
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
    all.push_back(verify_kit_case(request, each, tracer, all.empty(), progress));
    const VerifiedClaims& claims = all.back();
    if (claims.passed() || !claims.was_possible() || ++failed > kPrinted) continue;
    progress.clear();
    fmt::print("{}:\n", claims.name);
    print_disputes(claims, open_scene(each.scene.string()));
    fmt::print("\n");
  }
  progress.clear();
  if (failed > kPrinted) fmt::print("... and {} more cases failed\n\n", failed - kPrinted);
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
