#include "harness/cli/verify_hits.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/bench/record/machine.hpp"
#include "harness/cli/text.hpp"
#include "harness/render/diagnostics.hpp"
#include "harness/verify/describe.hpp"
#include "harness/verify/hit_files.hpp"
#include "scenes/core/error.hpp"
#include "scenes/core/files.hpp"

namespace beambench::cli {
namespace {

constexpr std::size_t kPrinted = 3;  // examples; the JSON has them all

/// Ties are no dispute, and grazes only where there are too many of them.
bool is_dispute(const verify::Mismatch& mismatch, verify::Verdict verdict) {
  if (mismatch.diff_class == verify::DiffClass::kTie) return false;
  return mismatch.diff_class != verify::DiffClass::kGraze || verdict == verify::Verdict::kGrazes;
}

void print(const VerifyHitsRequest& request, const scenes::Scene& scene,
           const verify::HitFilesReport& found, const std::string& picture) {
  const verify::DiffReport& report = found.report;
  fmt::print("{} over {}: {} {} of the rays of {}\n\n", request.hits, scene.name, report.rays,
             found.query == rays::Query::kAnyHit ? "any hits" : "closest hits", request.rays);
  TextTable table(
      {"rays", "hits", "agree", "tie", "graze", "structure error", "embree error", "verdict"}, 0);
  std::vector<std::string> row{fmt::format("{}", report.rays), fmt::format("{}", report.hits)};
  for (const std::uint64_t count : report.counts) row.push_back(fmt::format("{}", count));
  row.emplace_back(verify::to_string(report.verdict));
  table.add(std::move(row));
  fmt::print("{}", table.text());

  std::size_t disputes = 0;
  for (std::size_t i = 0; i < report.examples.size(); ++i) {
    if (!is_dispute(report.examples[i], report.verdict)) continue;
    if (++disputes > kPrinted) continue;
    fmt::print("\n{}", verify::describe(scene, found.places[i], report.examples[i], "claim"));
  }
  if (disputes > kPrinted) {
    fmt::print("\n... and {} more, which --json FILE writes\n", disputes - kPrinted);
  }
  if (!picture.empty()) fmt::print("\npicture: {}\n", picture);
}

void write_json(const VerifyHitsRequest& request, const scenes::Scene& scene,
                const verify::HitFilesReport& found, const std::string& picture) {
  const verify::DiffReport& report = found.report;
  nlohmann::ordered_json out{{"beambench", bench::build_info().version},
                             {"scene", scene.name},
                             {"primitives", scene.primitives.size()},
                             {"rays_file", request.rays},
                             {"hits_file", request.hits},
                             {"query", rays::to_string(found.query)},
                             {"verdict", verify::to_string(report.verdict)},
                             {"passed", verify::is_right(report.verdict)},
                             {"rays", report.rays},
                             {"hits", report.hits}};
  for (std::size_t i = 0; i < verify::kDiffClassNames.size(); ++i) {
    out[std::string(verify::kDiffClassNames[i])] = report.counts[i];
  }
  out["examples"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < report.examples.size(); ++i) {
    nlohmann::ordered_json example = to_json(report.examples[i]);
    example["place"] = found.places[i];
    out["examples"].push_back(std::move(example));
  }
  if (!picture.empty()) out["picture"] = picture;
  write_file(request.json, out.dump(2) + '\n');
}

/// Draws where the disputes are, where there are any; returns the file.
std::string draw(const VerifyHitsRequest& request, const scenes::Scene& scene,
                 const rays::ImageOfRays& image, const render::DisputedPlaces& places) {
  if (request.pictures.empty() || places.empty()) return "";
  const auto file =
      std::filesystem::path(request.pictures) /
      picture_name(fmt::format("{}-{}-{}", scene.name, image.camera.name,
                               std::filesystem::path(request.hits).filename().string()));
  render::write_disputed_places(file, scene, image.rays(), places);
  return file.string();
}

}  // namespace

int verify_hits(const VerifyHitsRequest& request) {
  if (!request.json.empty()) require_writable(request.json);
  const scenes::Scene scene = open_scene(request.scene);
  const rays::ImageOfRays image{choose_camera(scene, request.view),
                                rays::parse_resolution(request.resolution), 1};
  if (!request.pictures.empty()) make_picture_folder(request.pictures);
  render::DisputedPlaces places;
  base::Progress progress(1);
  const verify::HitFilesReport found = verify::verify_hit_files(
      scene, request.rays, request.hits,
      [&](const verify::Mismatch& mismatch) { places.add(mismatch); }, progress);
  progress.clear();
  const std::string picture = draw(request, scene, image, places);
  print(request, scene, found, picture);
  if (!request.json.empty()) write_json(request, scene, found, picture);
  return verify::is_right(found.report.verdict) ? base::kSuccess : base::kMismatch;
}

}  // namespace beambench::cli
