#include "harness/rays/trace_input.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "harness/rays/fingerprint.hpp"
#include "harness/rays/ray_generators.hpp"
#include "harness/rays/ray_set.hpp"
#include "scenes/core/error.hpp"

namespace beambench::rays {
namespace {

std::vector<accel::Ray> made_rays(const scenes::Scene& scene, const accel::PrimaryRays& primary,
                                  const RayChoice& choice) {
  if (choice.kind == RayKind::kRandom) {
    return random_rays(scene.bounds, primary.count(), choice.seed);
  }
  if (choice.kind == RayKind::kShadow && scene.lights.empty()) {
    throw NoRaysError(fmt::format(
        "scene '{}' has no lights, so it has no shadow rays; add an 'l' line to its file or ask "
        "for rays of another kind",
        scene.name));
  }
  const std::vector<PrimaryHitPoint> points = surface_points(scene, primary);
  switch (choice.kind) {
    case RayKind::kShadow:
      return shadow_rays(scene, points);
    case RayKind::kReflection:
      return reflection_rays(scene, points);
    case RayKind::kDiffuse:
      return diffuse_rays(scene, points, choice.seed);
    case RayKind::kPrimary:
    case RayKind::kRandom:
    case RayKind::kWhitted:
      break;
  }
  return {};
}

RaySet made_set(const scenes::Scene& scene, const accel::PrimaryRays& primary,
                const RayChoice& choice) {
  RaySet set{choice.label, info_of(choice.kind).query, choice.seed, scenes::scene_hash(scene),
             made_rays(scene, primary, choice)};
  if (set.rays.empty()) {
    throw NoRaysError(fmt::format(
        "there are no {} rays over scene '{}' at {}x{}: no primary ray hits a surface for them to "
        "start from; choose another camera or resolution",
        choice.label, scene.name, primary.width(), primary.height()));
  }
  return set;
}

RaySet read_for(const scenes::Scene& scene, const RayChoice& choice) {
  RaySet set = read_ray_file(choice.file);
  if (set.scene_hash && *set.scene_hash != scenes::scene_hash(scene)) {
    throw InputError(fmt::format(
        "{}: these rays were made for a scene with hash {}, but '{}' has {}; make them again with "
        "'beambench rays'",
        choice.label, hex_digits(*set.scene_hash), scene.name,
        hex_digits(scenes::scene_hash(scene))));
  }
  return set;
}

}  // namespace

TraceInput::TraceInput(accel::PrimaryRays rays) : image_(std::move(rays)) {}

TraceInput::TraceInput(RaySet rays) : list_(std::make_shared<const RaySet>(std::move(rays))) {}

std::size_t TraceInput::size() const { return list_ ? list_->rays.size() : image_->count(); }

accel::Ray TraceInput::ray(std::size_t index) const {
  if (list_) return list_->rays[index];
  const PixelSample at = *pixel(index);
  return image_->ray(at.x, at.y, at.sample);
}

const std::string& TraceInput::label() const {
  return list_ ? list_->label : info_of(RayKind::kPrimary).name;
}

std::optional<PixelSample> TraceInput::pixel(std::size_t index) const {
  if (!image_) return std::nullopt;
  const auto samples = static_cast<std::size_t>(image_->samples());
  const auto width = static_cast<std::size_t>(image_->width());
  return PixelSample{static_cast<int>(index / samples % width),
                     static_cast<int>(index / samples / width), static_cast<int>(index % samples)};
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
  // Row by row, so that the rays of a large image are never all in memory.
  const accel::PrimaryRays& image = *input.image();
  const std::size_t row_length = input.size() / static_cast<std::size_t>(image.height());
  double sum = 0.0;
  std::vector<accel::Ray> row;
  for (std::size_t first = 0; first < input.size(); first += row_length) {
    if (!row.empty()) row.erase(row.begin(), row.end() - 1);  // the step from row to row
    for (std::size_t i = 0; i < row_length; ++i) row.push_back(input.ray(first + i));
    sum += coherence(row) * static_cast<double>(row.size() - 1);
  }
  return input.size() < 2 ? 1.0 : sum / static_cast<double>(input.size() - 1);
}

accel::Workload workload_of(const ImageOfRays& image, const TraceInput& input, int threads) {
  return {image.camera, input.size(), threads};
}

TraceInput make_trace_input(const scenes::Scene& scene, const ImageOfRays& image,
                            const RayChoice& choice) {
  if (!choice.file.empty()) return TraceInput(read_for(scene, choice));
  if (choice.kind == RayKind::kWhitted) {
    throw InputError(
        "the rays of a whole picture follow from a structure's own hits, so they are no list; "
        "'whitted' is for the sweeps of 'beambench run', 'beambench verify' and 'render --shade', "
        "and 'beambench census' counts its rays");
  }
  accel::PrimaryRays primary(image.camera, image.resolution.width, image.resolution.height,
                             image.samples);
  if (choice.kind == RayKind::kPrimary) return {std::move(primary)};
  return TraceInput(made_set(scene, primary, choice));
}

}  // namespace beambench::rays
