#include "harness/rays/trace_input.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "harness/rays/fingerprint.hpp"
#include "harness/rays/lights.hpp"
#include "harness/rays/ray_file.hpp"
#include "harness/rays/ray_generators.hpp"
#include "harness/rays/ray_order.hpp"
#include "scenes/base/error.hpp"

namespace beambench::rays {
namespace {

constexpr std::int64_t kMaxRays = std::int64_t{1} << 28;

/// Parses the whole string as the side of an image.
std::optional<int> parse_side(std::string_view text) {
  int value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  if (value < 1 || value > Resolution::kMaxSide) return std::nullopt;
  return value;
}

/// Throws if a list would be too large. Unlike an image's rays, it is kept in memory, so its size
/// is checked before it is generated.
void require_list_size(std::size_t points, std::int64_t each, const RayChoice& choice,
                       std::string_view parameter) {
  const std::int64_t rays = static_cast<std::int64_t>(points) * each;
  if (rays <= kMaxRays) return;
  throw InputError(fmt::format(
      "{} rays from each of {} places where primary rays hit are up to {} '{}' rays, more than the "
      "{} that a list may have; lower the resolution or '{}'",
      each, points, rays, choice.label, kMaxRays, parameter));
}

void require_lights(const scenes::Scene& scene) {
  if (!scene.lights.empty()) return;
  throw NoRaysError(fmt::format(
      "scene '{}' has no lights, so it has no shadow rays; add an 'l' line to its file or ask for "
      "rays of another kind",
      scene.name));
}

RayList made_rays(const scenes::Scene& scene, const accel::PrimaryRays& primary,
                  const RayChoice& choice) {
  switch (choice.kind) {
    case RayKind::kShadow:
      require_lights(scene);
      return shadow_rays(scene.lights, in_picture_order(surface_points(scene, primary), primary));
    case RayKind::kArea: {
      require_lights(scene);
      const Parameters parameters = parameters_of(choice);
      const LightExtent extent{static_cast<int>(parameters.integer("samples")),
                               parameters.real("size")};
      const std::vector<scenes::Light> lights = area_lights(scene, extent);
      const auto points = in_picture_order(surface_points(scene, primary), primary);
      require_list_size(points.size(), static_cast<std::int64_t>(lights.size()), choice, "samples");
      return shadow_rays(lights, points, static_cast<std::size_t>(extent.points));
    }
    case RayKind::kReflection:
      return reflection_rays(surface_points(scene, primary));
    case RayKind::kMirror: {
      const MirrorTable mirrors(scene);
      if (mirrors.planes().empty()) {
        throw NoRaysError(
            fmt::format("scene '{}' has no planar mirrors, so it has no mirror rays; add a "
                        "specular factor to flat polygons in its file, or ask for 'reflection' "
                        "rays, for which all surfaces are mirrors",
                        scene.name));
      }
      return mirror_rays(in_picture_order(surface_points(scene, mirrors, primary), primary),
                         mirrors, primary);
    }
    case RayKind::kDiffuse:
      return diffuse_rays(surface_points(scene, primary), choice.seed);
    case RayKind::kOcclusion: {
      const Parameters parameters = parameters_of(choice);
      const auto samples = parameters.integer("samples");
      const double diagonal = glm::length(glm::dvec3(scene.bounds.upper - scene.bounds.lower));
      const auto points = surface_points(scene, primary);
      require_list_size(points.size(), samples, choice, "samples");
      return occlusion_rays(points, static_cast<int>(samples),
                            static_cast<float>(parameters.real("distance") * diagonal),
                            choice.seed);
    }
    case RayKind::kPath: {
      const auto bounces = parameters_of(choice).integer("bounces");
      const MirrorTable mirrors(scene);
      auto points = surface_points(scene, mirrors, primary);
      require_list_size(points.size(), bounces, choice, "bounces");
      return path_rays(scene, mirrors, std::move(points), static_cast<int>(bounces), choice.seed);
    }
    case RayKind::kRandom:
      return random_rays(scene.bounds, primary.count(), choice.seed);
    case RayKind::kPrimary:
    case RayKind::kWhitted:
      break;
  }
  return {};
}

RaySet made_set(const scenes::Scene& scene, const accel::PrimaryRays& primary,
                const RayChoice& choice) {
  RaySet set{made_rays(scene, primary, choice), choice.label, info_of(choice.kind).query,
             choice.seed, scenes::scene_hash(scene)};
  if (choice.is_sorted) sort_rays(set, scene.bounds);
  if (!set.samples.empty()) set.image = std::make_shared<const accel::PrimaryRays>(primary);
  if (set.rays.empty()) {
    throw NoRaysError(fmt::format(
        "there are no {} rays over scene '{}' at {}x{}: no primary ray hits a {} for them to start "
        "from; choose another camera or resolution",
        choice.label, scene.name, primary.width(), primary.height(),
        choice.kind == RayKind::kMirror ? "planar mirror" : "surface"));
  }
  return set;
}

}  // namespace

Resolution parse_resolution(std::string_view text) {
  const std::size_t cross = text.find('x');
  if (cross != std::string_view::npos) {
    const std::optional<int> width = parse_side(text.substr(0, cross));
    const std::optional<int> height = parse_side(text.substr(cross + 1));
    if (width && height) return {*width, *height};
  }
  throw InputError(fmt::format(
      "resolution '{}' is not WIDTHxHEIGHT with whole numbers from 1 to {}; write it as 640x480",
      text, Resolution::kMaxSide));
}

std::string to_string(const Resolution& resolution) {
  return fmt::format("{}x{}", resolution.width, resolution.height);
}

void require_ray_count(const Resolution& resolution, int samples) {
  const std::int64_t rays =
      std::int64_t{resolution.width} * std::int64_t{resolution.height} * std::int64_t{samples};
  if (rays <= kMaxRays) return;
  throw InputError(fmt::format(
      "{} pixels with {} samples each are {} rays, more than the {} that an image may have; lower "
      "the resolution or the samples",
      to_string(resolution), samples, rays, kMaxRays));
}

ImageOfRays image_of(const scenes::Camera& camera, const std::optional<Resolution>& resolution,
                     int samples) {
  const Resolution size = resolution.value_or(Resolution{camera.width, camera.height});
  require_ray_count(size, static_cast<int>(accel::sample_offsets(samples).size()));
  return {camera, size, samples};
}

PixelSample place_of(const accel::PrimaryRays& image, std::size_t index) {
  const auto samples = static_cast<std::size_t>(image.samples());
  const auto width = static_cast<std::size_t>(image.width());
  return {static_cast<int>(index / samples % width), static_cast<int>(index / samples / width),
          static_cast<int>(index % samples)};
}

std::size_t index_of(const accel::PrimaryRays& image, const PixelSample& at) {
  const auto samples = static_cast<std::size_t>(image.samples());
  const auto width = static_cast<std::size_t>(image.width());
  return (static_cast<std::size_t>(at.y) * width + static_cast<std::size_t>(at.x)) * samples +
         static_cast<std::size_t>(at.sample);
}

accel::Ray ray_at(const accel::PrimaryRays& image, std::size_t index) {
  const PixelSample at = place_of(image, index);
  return image.ray(at.x, at.y, at.sample);
}

TraceInput::TraceInput(accel::PrimaryRays rays) : image_(std::move(rays)) {}

TraceInput::TraceInput(RaySet rays) : list_(std::make_shared<const RaySet>(std::move(rays))) {}

std::size_t TraceInput::size() const { return list_ ? list_->rays.size() : image_->count(); }

accel::Ray TraceInput::ray(std::size_t index) const {
  return list_ ? list_->rays[index] : ray_at(*image_, index);
}

const std::string& TraceInput::label() const {
  return list_ ? list_->label : info_of(RayKind::kPrimary).name;
}

std::optional<PixelSample> TraceInput::pixel(std::size_t index) const {
  return image_ ? std::optional(place_of(*image_, index)) : std::nullopt;
}

double TraceInput::reach() const {
  if (image_) return glm::length(glm::dvec3(image_->eye()));
  double farthest = 0.0;
  for (const accel::Ray& ray : list_->rays) {
    farthest = std::max(farthest, glm::length(glm::dvec3(ray.origin)));
  }
  return farthest;
}

std::string place_text(const TraceInput& input, std::size_t index) {
  const auto at = input.pixel(index);
  return at ? fmt::format("pixel ({}, {}) sample {}", at->x, at->y, at->sample)
            : fmt::format("ray {}", index);
}

double coherence(const TraceInput& input) {
  if (input.list() != nullptr) return coherence(input.list()->rays);
  // Visits row by row, so that the rays of a large image are never all in memory.
  const accel::PrimaryRays& image = *input.image();
  const std::size_t row_length = input.size() / static_cast<std::size_t>(image.height());
  double sum = 0.0;
  std::vector<accel::Ray> row;
  for (std::size_t first = 0; first < input.size(); first += row_length) {
    if (!row.empty()) row.erase(row.begin(), row.end() - 1);  // keep the step between rows
    for (std::size_t i = 0; i < row_length; ++i) row.push_back(input.ray(first + i));
    sum += coherence(row) * static_cast<double>(row.size() - 1);
  }
  return input.size() < 2 ? 1.0 : sum / static_cast<double>(input.size() - 1);
}

accel::Workload workload_of(const ImageOfRays& image, const TraceInput& input, int threads) {
  return {image.camera, input.size(), threads, input.image() == nullptr};
}

void require_made_for(const scenes::Scene& scene, const RaySet& set) {
  if (!set.scene_hash || *set.scene_hash == scenes::scene_hash(scene)) return;
  throw InputError(fmt::format(
      "{}: these rays were made for a scene with hash {}, but '{}' has {}; make them again with "
      "'beambench rays'",
      set.label, hex_digits(*set.scene_hash), scene.name, hex_digits(scenes::scene_hash(scene))));
}

TraceInput make_trace_input(const scenes::Scene& scene, const ImageOfRays& image,
                            const RayChoice& choice) {
  if (!choice.file.empty()) {
    RaySet set = read_ray_file(choice.file);
    require_made_for(scene, set);
    return TraceInput(std::move(set));
  }
  if (choice.kind == RayKind::kWhitted) {
    throw InputError(
        "the rays of a whole picture follow from a structure's own hits, so they are not a list; "
        "'whitted' is for the sweeps of 'beambench run', 'beambench verify' and 'render --shade', "
        "and 'beambench census' counts its rays");
  }
  accel::PrimaryRays primary = image.rays();
  if (choice.kind == RayKind::kPrimary) return {std::move(primary)};
  return TraceInput(made_set(scene, primary, choice));
}

}  // namespace beambench::rays
