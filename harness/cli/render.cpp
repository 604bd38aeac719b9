// beambench render: draws a picture of a scene, or of a structure's work.

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "harness/cli/commands.hpp"
#include "harness/cli/inputs.hpp"
#include "harness/cli/text.hpp"
#include "harness/rays/hit_check.hpp"
#include "harness/rays/lights.hpp"
#include "harness/rays/trace_results.hpp"
#include "harness/render/diagnostics.hpp"
#include "harness/render/picture/image.hpp"
#include "harness/render/picture/image_file.hpp"
#include "harness/render/picture/tone.hpp"
#include "harness/render/shading.hpp"
#include "harness/render/structure_overlay.hpp"
#include "harness/render/whitted_picture.hpp"
#include "scenes/animation.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/files.hpp"
#include "scenes/base/printable.hpp"

namespace beambench::cli {
namespace {

/// The default structure for plain pictures: quick to build and to trace.
constexpr const char* kPlainStructure = "sah-bvh";

struct RenderRequest {
  std::string scene;
  std::string structure;
  std::string file;
  ImageRequest image;
  std::string heatmap;
  std::string difference;
  std::string shading = "preview";
  std::string overlay;
  WhittedRequest whitted;
  int light_points = 0;  ///< of each light; 0: lights are points
  double light_size = rays::LightExtent{}.size;
  std::string exposure = "0";
  std::uint32_t frame = 0;
  std::string frames;  ///< A-B; empty: one picture, of `frame`
};

/// The frames of a request, from the first to the last.
struct FrameRange {
  std::uint32_t first;
  std::uint32_t last;
};

/// Parses A-B. Throws InputError unless these are frames of the animation.
FrameRange parse_frames(std::string_view text, const scenes::Animation& animation) {
  FrameRange range{};
  const char* const stop = text.data() + text.size();
  const auto [dash, error] = std::from_chars(text.data(), stop, range.first);
  if (error == std::errc() && dash != stop && *dash == '-') {
    const auto [end, fault] = std::from_chars(dash + 1, stop, range.last);
    const bool valid = fault == std::errc() && end == stop && range.first <= range.last;
    if (valid && range.last < animation.frames) return range;
  }
  throw InputError(fmt::format(
      "--frames '{}' is not A-B, from frame A to frame B; {}", text,
      animation.frames > 1
          ? fmt::format("{} has the frames 0-{}", animation.scene.name, animation.frames - 1)
          : fmt::format("{} does not move", animation.scene.name)));
}

/// Returns `dir/out_0007.png` for `dir/out.png` and frame 7.
std::string numbered_file(const std::string& file, std::uint32_t frame) {
  std::filesystem::path path(file);
  const std::string name =
      fmt::format("{}_{:04}{}", path.stem().string(), frame, path.extension().string());
  return path.replace_filename(name).string();
}

/// The value of --exposure that lets the picture determine the exposure.
constexpr std::string_view kAuto = "auto";

/// Parses --exposure; returns nothing for `auto`.
std::optional<double> parse_exposure(std::string_view text) {
  constexpr double kMaxStops = 32.0;
  if (text == kAuto) return std::nullopt;
  double stops = 0.0;
  const char* const stop = text.data() + text.size();
  const char* const start = text.starts_with('+') ? text.data() + 1 : text.data();
  const auto [at, error] = std::from_chars(start, stop, stops);
  if (error == std::errc() && at == stop && std::abs(stops) <= kMaxStops) return stops;
  throw InputError(fmt::format(
      "--exposure '{}' is neither '{}' nor a number of stops from -{} to {}; write it as -0.5",
      text, kAuto, kMaxStops, kMaxStops));
}

/// Returns whether the shading shows light, rather than numbers as colors.
bool shows_light(render::Shading shading) {
  return shading == render::Shading::kPreview || shading == render::Shading::kWhitted;
}

void require_exposure(const RenderRequest& request) {
  const std::optional<double> stops = parse_exposure(request.exposure);
  if (stops == 0.0) return;
  if (!shows_light(render::parse_shading(request.shading))) {
    throw InputError("--exposure applies to light; use it with --shade preview or --shade whitted");
  }
  if (!stops && render::image_format(request.file) == render::ImageFormat::kExr) {
    throw InputError("--exposure auto fits a picture to a display, but an .exr keeps all light");
  }
}

/// Returns the depth and id of each pixel, taken from its nearest sample.
std::vector<render::DataChannel> hit_channels(const accel::HitBuffer& hits) {
  std::vector<float> depth;
  std::vector<std::uint32_t> id;
  for (std::size_t first = 0; first < hits.size();
       first += static_cast<std::size_t>(hits.samples())) {
    accel::Hit nearest{accel::kInfinity, scenes::kNoPrimitive};
    for (std::size_t i = first; i < first + static_cast<std::size_t>(hits.samples()); ++i) {
      if (const auto hit = hits.get(i); hit && accel::precedes(*hit, nearest)) nearest = *hit;
    }
    depth.push_back(nearest.t);
    id.push_back(nearest.primitive);
  }
  std::vector<render::DataChannel> channels;
  channels.push_back({"Z", std::move(depth)});
  channels.push_back({"id", std::move(id)});
  return channels;
}

/// Writes a heat map: a PNG with a legend, or an EXR with the numbers.
void write_heat_map(const RenderRequest& request, const render::HeatMap& map,
                    const accel::HitBuffer& hits) {
  if (render::image_format(request.file) == render::ImageFormat::kPng) {
    render::write_image(request.file, render::draw_heat_map_with_legend(map));
    return;
  }
  std::vector<render::DataChannel> channels = hit_channels(hits);
  channels.push_back({request.heatmap, map.values});
  render::write_image(request.file, render::draw_heat_map(map), channels);
}

std::string describe(const std::vector<render::LegendEntry>& legend) {
  std::string text;
  for (const render::LegendEntry& entry : legend)
    text += fmt::format("; {}: {}", entry.name, entry.count);
  return text;
}

render::Image shaded(const RenderRequest& request, const accel::StructureChoice& choice,
                     const accel::Accelerator& accelerator, const scenes::Scene& scene,
                     const accel::PrimaryRays& rays, const accel::HitBuffer& hits,
                     base::Progress& progress) {
  const render::Shading shading = render::parse_shading(request.shading);
  if (shading != render::Shading::kWhitted) return render::shade(scene, rays, hits, shading);
  const render::Whitted tracer(scene, accelerator, whitted_options(request.whitted),
                               rays::HitCheck(scene, choice));
  return render::whitted_picture(
             tracer, rays, hits, [&](double part) { progress.advance(part); },
             request.whitted.threads)
      .image;
}

/// Returns a remark if a picture is too bright: in files of other programs, lights may be meant to
/// fall off with distance, but in beambench they do not. An EXR keeps all light.
std::string remark_on_light(const RenderRequest& request, double stops,
                            const render::Image& image) {
  constexpr double kWorthSaying = 0.05;
  if (render::parse_shading(request.shading) != render::Shading::kWhitted) return "";
  if (render::image_format(request.file) != render::ImageFormat::kPng) return "";
  const render::Overexposure found = render::overexposure(image);
  if (found.share <= kWorthSaying) return "";
  return fmt::format(
      "; {:.0f}% of the pixels are brighter than white; '--exposure {:.1f}' leaves 1%, "
      "'--exposure {}' keeps the other pixels bright",
      100.0 * found.share, stops + found.remedy, kAuto);
}

/// Exposes a picture according to --exposure; returns remarks about it.
std::string exposed(const RenderRequest& request, render::Image& image) {
  if (const std::optional<double> stops = parse_exposure(request.exposure)) {
    if (*stops != 0.0) render::expose(image, *stops);
    return remark_on_light(request, *stops, image);
  }
  const render::ToneCurve curve = render::choose_tone(image);
  render::apply(image, curve);
  return fmt::format("; exposure {:+.1f}, white {:.2f}", curve.stops(), curve.white());
}

/// Shades the hits and draws the overlay, with a legend in a PNG; returns remarks about the
/// picture.
std::string write_shaded(const RenderRequest& request, const accel::StructureChoice& choice,
                         std::optional<render::OverlayChoice> overlay,
                         const accel::Accelerator& accelerator, const scenes::Scene& scene,
                         const accel::PrimaryRays& rays, const accel::HitBuffer& hits,
                         base::Progress& progress) {
  render::Image image = shaded(request, choice, accelerator, scene, rays, hits, progress);
  const std::string remark = exposed(request, image);
  std::vector<render::LegendEntry> legend;
  if (overlay) legend = render::draw_overlay(*overlay, image, accelerator, scene, rays);
  if (overlay && render::image_format(request.file) == render::ImageFormat::kPng) {
    const std::string title =
        fmt::format("{} of {}, {}", request.overlay, choice.short_label(), scene.name);
    render::write_image(request.file, render::with_legend(image, title, legend));
  } else {
    render::write_image(request.file, image, hit_channels(hits));
  }
  return describe(legend) + remark;
}

std::string share_of_hits(const accel::HitBuffer& hits) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) count += hits.get(i).has_value();
  return format_share(count, hits.size()) + " of the rays hit something";
}

/// Returns a remark about a map without any work, which is correct but may look like an error.
std::string remark_on(const render::HeatMap& map, const accel::StructureChoice& choice) {
  const bool dark =
      std::all_of(map.values.begin(), map.values.end(), [](float v) { return v == 0; });
  return dark ? fmt::format("; {} counts none of this work, or no ray causes any",
                            choice.info().name)
              : "";
}

/// Returns the reference for --difference: the oracle, or the hits of another structure.
verify::ReferenceHits find_reference(const RenderRequest& request, const scenes::Scene& scene,
                                     const accel::PrimaryRays& rays) {
  if (request.difference == render::kOracleName) return {scene, rays};
  const accel::StructureChoice other = choose_one("--difference", request.difference);
  rays::TraceResults results = rays::make_results(rays);
  rays::trace(*other.build(scene, rays::workload_of(choose_image(scene, request.image), rays)),
              rays, results);
  rays::HitCheck(scene, other).require(std::get<accel::HitBuffer>(results), rays);
  return render::reference_from(scene, rays, results);
}

/// Writes the picture of differences; returns a string with their numbers.
std::string compare(const RenderRequest& request, const accel::StructureChoice& choice,
                    const scenes::Scene& scene, const accel::PrimaryRays& rays,
                    const rays::TraceResults& results) {
  const verify::ReferenceHits reference = find_reference(request, scene, rays);
  std::vector<verify::DiffClass> classes(rays.count());
  const verify::DiffReport report =
      verify::verify_results(reference, results, accel::Conformance::kTolerance, classes);
  render::write_difference(request.file, reference, classes,
                           {choice.short_label(), request.difference});
  return fmt::format(
      "{} of {} rays differ from {}: {} ties, {} grazes, {} wrong, {} wrong in the reference",
      report.rays - report.count(verify::DiffClass::kAgree), report.rays, request.difference,
      report.count(verify::DiffClass::kTie), report.count(verify::DiffClass::kGraze),
      report.count(verify::DiffClass::kStructureError),
      report.count(verify::DiffClass::kOracleError));
}

/// Returns the structure for a picture: plain pictures are the same for any structure, while other
/// pictures show what one structure does.
accel::StructureChoice chosen_structure(const RenderRequest& request) {
  if (!request.structure.empty()) return choose_one("--accel", request.structure);
  for (const auto& [option, value] :
       {std::pair("--heatmap", &request.heatmap), std::pair("--difference", &request.difference),
        std::pair("--overlay", &request.overlay)}) {
    if (value->empty()) continue;
    throw InputError(
        fmt::format("{} shows what a structure does; name the structure with --accel", option));
  }
  return choose_one("--accel", kPlainStructure);
}

/// Draws the picture of a request over a scene in the requested frame; returns a line about it.
std::string draw(const RenderRequest& request, const accel::StructureChoice& choice,
                 std::optional<render::OverlayChoice> overlay, const scenes::Scene& scene,
                 base::Progress& progress) {
  const render::Shading shading = render::parse_shading(request.shading);
  const rays::ImageOfRays image = choose_image(scene, request.image);
  const accel::PrimaryRays rays = image.rays();

  const std::string name =
      request.frames.empty() ? scene.name : fmt::format("{}, frame {}", scene.name, request.frame);
  progress.start(fmt::format("{} over {}", choice.info().name, name));
  const auto accelerator = choice.build(scene, {image.camera, rays.count(), request.whitted.threads,
                                                shading == render::Shading::kWhitted});
  rays::TraceResults results = rays::make_results(rays);
  auto& hits = std::get<accel::HitBuffer>(results);
  const rays::HitCheck check(scene, choice);
  std::string found;
  if (!request.heatmap.empty()) {
    const render::HeatMap map =
        render::count_work(*accelerator, rays, request.heatmap, hits, progress);
    check.require(hits, rays);
    write_heat_map(request, map, hits);
    found = share_of_hits(hits) + remark_on(map, choice);
  } else {
    rays::trace_with_progress(*accelerator, rays, results, request.whitted.threads, progress);
    if (request.difference.empty()) {
      check.require(hits, rays);
      found = share_of_hits(hits) +
              write_shaded(request, choice, overlay, *accelerator, scene, rays, hits, progress);
    } else {
      found = compare(request, choice, scene, rays, results);
    }
  }
  return fmt::format("{}: {} by {}, {}x{}, {}", printable(request.file), scene.name,
                     choice.short_label(), rays.width(), rays.height(), found);
}

void render(const RenderRequest& request) {
  const render::Shading shading = render::parse_shading(request.shading);
  require_exposure(request);
  if (request.light_points > 0 && shading != render::Shading::kWhitted) {
    throw InputError("--soft-shadows applies to light; use it with --shade whitted");
  }
  whitted_options(request.whitted);
  render::image_format(request.file);
  if (request.frames.empty()) require_writable(request.file);
  if (!request.difference.empty() && request.difference != render::kOracleName) {
    choose_one("--difference", request.difference);
  }
  const accel::StructureChoice choice = chosen_structure(request);
  std::optional<render::OverlayChoice> overlay;
  if (!request.overlay.empty()) overlay = render::parse_overlay(request.overlay, choice.info());
  scenes::Animation animation = open_animation(request.scene);
  if (request.light_points > 0) {  // of frame 0: lights do not grow with the scene's box
    animation.scene.lights =
        rays::area_lights(animation.scene, {request.light_points, request.light_size});
  }
  if (overlay) render::require_light(*overlay, animation.scene);
  if (request.frames.empty()) {
    if (request.frame > 0) scenes::show_frame(animation, request.frame);
    base::Progress progress(1);
    progress.say(draw(request, choice, overlay, animation.scene, progress));
    return;
  }
  const auto [first, last] = parse_frames(request.frames, animation);
  for (std::uint32_t frame = first; frame <= last; ++frame) {
    require_writable(numbered_file(request.file, frame));
  }
  base::Progress progress(last - first + 1);
  for (std::uint32_t frame = first; frame <= last; ++frame) {
    scenes::show_frame(animation, frame);
    RenderRequest single = request;
    single.frame = frame;
    single.file = numbered_file(request.file, frame);
    progress.finish(draw(single, choice, overlay, animation.scene, progress));
  }
  progress.say(fmt::format("{} to {}: {}", printable(numbered_file(request.file, first)),
                           printable(numbered_file(request.file, last)),
                           base::counted(last - first + 1, "picture")));
}

}  // namespace

void add_render_command(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand("render", "Draw a scene, or the work of a structure");
  const auto request = std::make_shared<RenderRequest>();
  add_scene_option(*command, request->scene);
  command->add_option("--accel", request->structure,
                      fmt::format("Structure: NAME:parameter=value,... (default, for a plain "
                                  "picture: {})",
                                  kPlainStructure));
  command->add_option("-o", request->file, "Picture to write, .png or .exr")->required();
  CLI::Option* frame = add_frame_option(*command, request->frame);
  command
      ->add_option("--frames", request->frames,
                   "Pictures of the frames A to B of an animated scene; -o out.png writes "
                   "out_0000.png and so on")
      ->type_name("A-B")
      ->excludes(frame);
  add_image_options(*command, request->image);
  CLI::Option* shade =
      command
          ->add_option(
              "--shade", request->shading,
              "preview, normals, id, depth, or whitted: lights, shadows, mirrors and glass")
          ->capture_default_str();
  add_whitted_options(*command, request->whitted);
  CLI::Option* soft =
      command
          ->add_option("--soft-shadows", request->light_points,
                       "Lights are balls, each represented by this many points (with --shade "
                       "whitted); 16 for a draft, 64 or more for a final picture")
          ->check(whole_number_in(1, rays::kMaxLightPoints));
  command
      ->add_option("--light-size", request->light_size,
                   "Diameter of these balls, in diagonals of the scene's box")
      ->capture_default_str()
      ->check(number_in(0.0, 1e6))
      ->needs(soft);
  CLI::Option* exposure =
      command
          ->add_option("--exposure", request->exposure,
                       "Exposure in stops: -1 halves the light, 1 doubles it; 'auto': brightens a "
                       "dark picture and rolls off a bright one, so that at most 1% of the pixels "
                       "are clipped")
          ->type_name("STOPS|auto")
          ->capture_default_str();
  CLI::Option* heatmap = command
                             ->add_option("--heatmap", request->heatmap,
                                          "Show a work counter as colors, instead of shading")
                             ->excludes(exposure)
                             ->excludes(shade);
  CLI::Option* difference =
      command
          ->add_option("--difference", request->difference,
                       "Show where the hits differ from those of another structure, or from the "
                       "'oracle' of 'beambench verify', instead of shading")
          ->excludes(heatmap)
          ->excludes(exposure);
  command
      ->add_option("--overlay", request->overlay,
                   "Draw over the dimmed shading: 'beams', the outlines of beams; 'cells', the "
                   "occupied cells in perspective; or 'pencils', the shadow rays of a light "
                   "('pencils:light=2': the second light) as they are traced together")
      ->excludes(heatmap)
      ->excludes(difference);
  command->footer(
      "Counters for --heatmap: traversal_steps, leaves, empty_leaves, box_tests, primitive_tests,\n"
      "and a structure's own. A .png gets a legend; an .exr has the counts beside linear float\n"
      "R, G, B, the depth Z and the primitive id (4294967295 for a miss). --difference colors\n"
      "pixels by the classes of 'beambench verify --help'.\n"
      "--overlay beams colors beams that end at occupied leaves, that continue, or that leave the\n"
      "scene; for tile-beam it draws tiles and their blocks of 4x4 samples.\n"
      "--overlay cells omits cells that others hide. --overlay pencils draws the parts\n"
      "of a light's pencil and their blocks, in colors for the sides of a cube about the light.\n"
      "Examples:\n"
      "  beambench render escena1 -o escena1.png\n"
      "  beambench render balls -o from-above.png --from 0,0,5 --up 0,1,0 --angle 30\n"
      "  beambench render balls:n=3 --accel samet -o work.png --heatmap primitive_tests\n"
      "  beambench render tetra --accel embree:robust=false -o wrong.png --difference oracle\n"
      "  beambench render escena2 --accel beam:max_level=5 -o beams.png --overlay beams\n"
      "  beambench render balls --accel tile-beam -o pencils.png --overlay pencils:light=2\n"
      "  beambench render balls:n=3 --accel beam -o balls.png --shade whitted --samples 4\n"
      "  beambench render rings -o rings.png --shade whitted --exposure auto\n"
      "  beambench render waving-sheet --frames 0-19 -o sheet.png\n"
      "  beambench render balls -o soft.png --shade whitted --soft-shadows 64\n"
      "  beambench render tetra --accel embree -o tetra.exr --resolution 640x480 --samples 4");
  command->callback([request] { render(*request); });
}

}  // namespace beambench::cli
