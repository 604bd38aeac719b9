// beambench mirrors: what planar mirrors show, by beams and by individual reflected rays.

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "accel/beam/mirror_beams.hpp"
#include "harness/base/counted.hpp"
#include "harness/base/stopwatch.hpp"
#include "harness/bench/record/robust_statistics.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/inputs.hpp"
#include "harness/cli/text.hpp"
#include "harness/rays/hit_check.hpp"
#include "scenes/core/error.hpp"

namespace beambench::cli {
namespace {

struct Request {
  std::string scene;
  std::string structure = "beam";
  ImageRequest image{"640x480", {}, 1};
  int repetitions = 5;
  bool json = false;
};

/// One mirror: what it shows, and how long finding that took.
struct Result {
  std::size_t polygons;
  std::size_t samples;
  std::size_t hits;
  std::size_t different;  ///< answers of the two ways
  double rays_ms;
  double beams_ms;
};

template <class Work>
double median_ms(int repetitions, Work work) {
  std::vector<double> times;
  for (int i = 0; i < repetitions; ++i) {
    const base::Stopwatch stopwatch;
    work();
    times.push_back(stopwatch.milliseconds());
  }
  return bench::median(times);
}

/// The samples of an image that see a mirror.
std::vector<rays::PixelSample> seeing(const accel::beam::PlanarMirror& mirror,
                                      const accel::HitBuffer& hits) {
  std::vector<rays::PixelSample> samples;
  for (int y = 0; y < hits.height(); ++y) {
    for (int x = 0; x < hits.width(); ++x) {
      for (int sample = 0; sample < hits.samples(); ++sample) {
        const scenes::PrimitiveId id = hits.primitive()[hits.index(x, y, sample)];
        if (std::binary_search(mirror.polygons.begin(), mirror.polygons.end(), id)) {
          samples.push_back({x, y, sample});
        }
      }
    }
  }
  return samples;
}

/// By single rays through the same octree, made as they are needed.
void trace_singly(const accel::beam::BeamTracer& tracer, const accel::beam::MirrorView& view,
                  const std::vector<rays::PixelSample>& samples, accel::HitBuffer& found) {
  for (const rays::PixelSample& at : samples) {
    found.set(found.index(at.x, at.y, at.sample),
              tracer.closest_hit(accel::beam::ray_behind(view, at.x, at.y, at.sample), nullptr));
  }
}

Result compare(const accel::beam::BeamTracer& tracer, const accel::beam::MirrorView& view,
               const accel::HitBuffer& hits, const accel::beam::PlanarMirror& mirror,
               int repetitions) {
  accel::HitBuffer by_rays(hits.width(), hits.height(), hits.samples());
  accel::HitBuffer by_beams = by_rays;
  Result result{mirror.polygons.size(), view.samples, 0, 0, 0.0, 0.0};
  const std::vector<rays::PixelSample> samples = seeing(mirror, hits);
  result.rays_ms = median_ms(repetitions, [&] { trace_singly(tracer, view, samples, by_rays); });
  result.beams_ms =
      median_ms(repetitions, [&] { tracer.trace_behind(view.sight, view.rays, by_beams); });
  for (std::size_t i = 0; i < hits.size(); ++i) {
    result.hits += by_rays.get(i).has_value() ? 1 : 0;
    result.different += by_rays.get(i) == by_beams.get(i) ? 0 : 1;
  }
  return result;
}

Result sum_of(const std::vector<Result>& results) {
  Result all{0, 0, 0, 0, 0.0, 0.0};
  for (const Result& each : results) {
    all.polygons += each.polygons;
    all.samples += each.samples;
    all.hits += each.hits;
    all.different += each.different;
    all.rays_ms += each.rays_ms;
    all.beams_ms += each.beams_ms;
  }
  return all;
}

void print_text(const scenes::Scene& scene, const Request& request, std::size_t mirrors,
                const std::vector<Result>& results) {
  fmt::print("{}: {}, {} seen at {}, {}\n\n", scene.name, base::counted(mirrors, "planar mirror"),
             results.size(), request.image.resolution, request.structure);
  TextTable table({"mirror", "polygons", "samples", "that hit", "rays", "beams", "rays/beams"});
  for (const Result& result : results) {
    table.add({fmt::format("{}", &result - results.data() + 1), fmt::format("{}", result.polygons),
               fmt::format("{}", result.samples), format_share(result.hits, result.samples),
               fmt::format("{:.4g} ms", result.rays_ms), fmt::format("{:.4g} ms", result.beams_ms),
               fmt::format("{:.2f}", result.rays_ms / result.beams_ms)});
  }
  const Result all = sum_of(results);
  if (results.size() > 1) {
    table.add({"all", fmt::format("{}", all.polygons), fmt::format("{}", all.samples),
               format_share(all.hits, all.samples), fmt::format("{:.4g} ms", all.rays_ms),
               fmt::format("{:.4g} ms", all.beams_ms),
               fmt::format("{:.2f}", all.rays_ms / all.beams_ms)});
  }
  fmt::print("{}", table.text());
}

void print_json(const scenes::Scene& scene, const Request& request, std::size_t mirrors,
                const std::vector<Result>& results) {
  nlohmann::ordered_json out{{"scene", scene.name},
                             {"structure", request.structure},
                             {"resolution", request.image.resolution},
                             {"samples", request.image.samples},
                             {"repetitions", request.repetitions},
                             {"planar_mirrors", mirrors},
                             {"seen", nlohmann::ordered_json::array()}};
  for (const Result& result : results) {
    out["seen"].push_back({{"polygons", result.polygons},
                           {"samples", result.samples},
                           {"hits", result.hits},
                           {"different", result.different},
                           {"rays_ms", result.rays_ms},
                           {"beams_ms", result.beams_ms}});
  }
  fmt::print("{}\n", out.dump(2));
}

/// Returns false when the two ways found different things.
bool show_mirrors(const Request& request) {
  const accel::StructureChoice choice = choose_one("--accel", request.structure);
  const scenes::Scene scene = open_scene(request.scene);
  const accel::PrimaryRays rays = choose_rays(scene, request.image);
  const auto structure =
      choice.build(scene, rays::workload_of(choose_image(scene, request.image), rays));
  const auto* tracer = dynamic_cast<const accel::beam::BeamTracer*>(structure.get());
  if (tracer == nullptr) {
    throw InputError(fmt::format(
        "'{}' traces no beams to be reflected; give --accel beam, with parameters if you like",
        choice.info().name));
  }
  accel::HitBuffer hits(rays.width(), rays.height(), rays.samples());
  tracer->trace(rays, hits, nullptr);
  rays::HitCheck(scene, choice).require(hits, rays);
  const std::vector<accel::beam::PlanarMirror> mirrors = accel::beam::planar_mirrors(scene);
  std::vector<Result> results;
  std::size_t different = 0;
  for (const accel::beam::PlanarMirror& mirror : mirrors) {
    const auto view = accel::beam::view_in(mirror, scene, rays, hits);
    if (!view) continue;
    results.push_back(compare(*tracer, *view, hits, mirror, request.repetitions));
    different += results.back().different;
  }
  if (request.json) {
    print_json(scene, request, mirrors.size(), results);
  } else {
    print_text(scene, request, mirrors.size(), results);
  }
  return different == 0;
}

}  // namespace

void add_mirrors_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("mirrors", "Reflected rays at planar mirrors, in beams and one by one");
  const auto request = std::make_shared<Request>();
  add_scene_option(*command, request->scene);
  command->add_option("--accel", request->structure, "beam, with parameters where wanted")
      ->capture_default_str();
  add_image_options(*command, request->image);
  command->add_option("--repetitions", request->repetitions, "Times each way is timed")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  command->add_flag("--json", request->json, "Print JSON instead of text");
  command->footer(
      "A planar mirror shows what a virtual eye behind it sees (Heckbert and Hanrahan 1984): its\n"
      "rays go in beams from the mirror on, the thesis's first line of future work, and one by "
      "one\n"
      "through the same octree. Flat polygons of one plane whose surface reflects are one mirror.\n"
      "Ends with 1 if the two ways find different hits.\n"
      "Examples:\n"
      "  beambench mirrors teapot\n"
      "  beambench mirrors habitacion --accel beam:max_level=7,handover=48 --resolution 320x200\n"
      "  beambench mirrors teapot:n=3 --accel beam:max_level=6 --json");
  command->callback([request, &exit_code] {
    exit_code = show_mirrors(*request) ? base::kSuccess : base::kMismatch;
  });
}

}  // namespace beambench::cli
