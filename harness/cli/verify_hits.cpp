#include "harness/cli/verify_hits.hpp"

#include <algorithm>
#include <cstddef>
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

constexpr std::size_t kPrinted = 3;  // examples; the JSON has them all

/// The findings for one file of rays.
struct VerifiedClaims {
  std::string name;  ///< of the case
  std::string scene;
  std::size_t primitives = 0;
  verify::ClaimsReport found;
  std::string picture{};  ///< the picture's file; empty: none
  std::string minimal{};  ///< a line about the reduction; empty: none

  bool passed() const { return verify::is_right(found.report.verdict); }
};

/// Returns whether a mismatch is a dispute: ties are not, and grazes only if there are too many.
bool is_dispute(const verify::Mismatch& mismatch, verify::Verdict verdict) {
  if (mismatch.diff_class == verify::DiffClass::kTie) return false;
  return mismatch.diff_class != verify::DiffClass::kGraze || verdict == verify::Verdict::kGrazes;
}

std::string table_text(std::span<const VerifiedClaims> all, const std::string& first_column) {
  std::vector<std::string> header{first_column, "query", "rays", "hits"};
  for (const char* name : {"agree", "tie", "graze", "structure error", "embree error", "verdict"}) {
    header.emplace_back(name);
  }
  TextTable table(std::move(header), 2);
  for (const VerifiedClaims& each : all) {
    const verify::DiffReport& report = each.found.report;
    std::vector<std::string> row{each.name, std::string(rays::to_string(each.found.query)),
                                 fmt::format("{}", report.rays), fmt::format("{}", report.hits)};
    for (const std::uint64_t count : report.counts) row.push_back(fmt::format("{}", count));
    row.emplace_back(verify::to_string(report.verdict));
    table.add(std::move(row));
  }
  return table.text();
}

void print_disputes(const VerifiedClaims& claims, const scenes::Scene& scene) {
  const verify::DiffReport& report = claims.found.report;
  std::size_t disputes = 0;
  for (std::size_t i = 0; i < report.examples.size(); ++i) {
    if (!is_dispute(report.examples[i], report.verdict)) continue;
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
           {"scene", claims.scene},
           {"primitives", claims.primitives},
           {"query", rays::to_string(claims.found.query)},
           {"verdict", verify::to_string(report.verdict)},
           {"passed", claims.passed()},
           {"rays", report.rays},
           {"hits", report.hits}};
  for (std::size_t i = 0; i < verify::kDiffClassNames.size(); ++i) {
    out[std::string(verify::kDiffClassNames[i])] = report.counts[i];
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

void write_json(const VerifyHitsRequest& request, std::span<const VerifiedClaims> all) {
  Json out{{"beambench", measure::build_info().version},
           {"passed", std::ranges::all_of(all, &VerifiedClaims::passed)},
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
  const auto collect = [&](const verify::Mismatch& mismatch) { places.add(mismatch); };
  VerifiedClaims claims{
      printable(files.name), scene.name, scene.primitives.size(),
      tracer ? verify::verify_traced_file(scene, files.rays, *tracer, collect, progress)
             : verify::verify_hit_files(scene, files.rays, files.hits, collect, progress)};
  const verify::DiffReport& report = claims.found.report;
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

void require_outputs(const VerifyHitsRequest& request) {
  if (!request.json.empty()) require_writable(request.json);
  if (!request.pictures.empty()) make_folder(request.pictures, "choose another with --pictures");
}

}  // namespace

std::string case_text(const std::filesystem::path& folder, const verify::MinimalCase& minimal) {
  return fmt::format("reduced to {} and {}, in {}{}",
                     base::counted(minimal.primitives.size(), "primitive"),
                     base::counted(minimal.input.size(), "ray"), printable(folder.string()),
                     minimal.repeated ? ""
                                      : ": what the answers name; with --command it is traced "
                                        "again, which shows whether these are enough");
}

std::string minimized_text(const std::string& folder, const std::string& name,
                           const scenes::Scene& scene, const rays::TraceInput& input,
                           const verify::DiffReport& report, const verify::Tracer& tracer,
                           const std::string& subject, base::Progress& progress) {
  const auto minimal = verify::minimize(scene, input, report.examples.front(),
                                        verify::wrong_by_differ(tracer), progress);
  if (!minimal) return "not reduced: the answer is right when the same rays are traced again";
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
  const VerifiedClaims claims = verify_case(
      request, scene, {file.filename().string(), request.scene, request.rays, request.hits}, tracer,
      progress);
  progress.clear();
  fmt::print("{} over {}\n\n{}", subject_of(request, request.hits), scene.name,
             table_text({&claims, 1}, "file"));
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
          "{}: there are no hits beside the rays; trace {} and write them, or give --command",
          each.hits.string(), each.rays.string()));
    }
  }
  base::Progress progress(cases.size());
  std::vector<VerifiedClaims> all;
  std::size_t failed = 0;
  for (const verify::KitCase& each : cases) {
    const scenes::Scene scene = open_scene(each.scene.string());
    all.push_back(verify_case(request, scene, each, tracer, progress));
    if (all.back().passed() || ++failed > kPrinted) continue;
    progress.clear();
    fmt::print("{}:\n", printable(each.name));
    print_disputes(all.back(), scene);
    fmt::print("\n");
  }
  progress.clear();
  fmt::print("{}", table_text(all, "case"));
  fmt::print("\n{}: {} of {} cases right\n", subject_of(request, request.kit), all.size() - failed,
             all.size());
  if (!request.json.empty()) write_json(request, all);
  return failed == 0 ? base::kSuccess : base::kMismatch;
}

}  // namespace beambench::cli
