#include "harness/render/whitted.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "accel/core/primary_rays.hpp"
#include "harness/rays/normal.hpp"
#include "harness/render/picture/color.hpp"
#include "harness/render/shading.hpp"

namespace beambench::render {
namespace {

using glm::dvec3;

constexpr double kAmbient = 0.06;  // of white light, from everywhere

/// Rays of a wave that are shaded together: what is computed of them stays in the caches.
constexpr std::size_t kPart = 4096;

std::vector<dvec3> light_colors(const scenes::Scene& scene) {
  std::vector<dvec3> colors;
  colors.reserve(scene.lights.size());
  const double share =
      1.0 / std::sqrt(static_cast<double>(std::max<std::size_t>(scene.lights.size(), 1)));
  for (const scenes::Light& light : scene.lights) {
    const bool unsaid = light.color == glm::vec3(1.0F);
    colors.push_back(unsaid ? dvec3(share) : dvec3(light.color));
  }
  return colors;
}

/// A direction on the outer side of the surface: a smooth polygon's shading normal may send it
/// through the polygon.
dvec3 mirrored_outward(const dvec3& incoming, const dvec3& shading, const dvec3& geometric) {
  const dvec3 direction = accel::mirrored(incoming, shading);
  return glm::dot(direction, geometric) > 0.0 ? direction : accel::mirrored(incoming, geometric);
}

/// The same for the inner side.
std::optional<dvec3> refracted_inward(const dvec3& incoming, const dvec3& shading,
                                      const dvec3& geometric, double ratio) {
  const auto direction = refracted(incoming, shading, ratio);
  const bool outward = direction && glm::dot(*direction, geometric) >= 0.0;
  return outward ? refracted(incoming, geometric, ratio) : direction;
}

/// What the diffuse factor leaves of a display color, in linear light.
dvec3 matte(const scenes::Surface& surface, const dvec3& color) {
  const dvec3 display = glm::clamp(color, 0.0, 1.0);
  return double{surface.diffuse} * dvec3(linear_from_srgb(glm::vec3(display)));
}

accel::Ray ray_from(const dvec3& origin, const dvec3& direction) {
  accel::Ray ray;
  ray.origin = glm::vec3(origin);
  ray.direction = glm::vec3(direction);
  return ray;
}

/// The hits of a batch of rays, counted.
accel::HitBuffer traced(const accel::Accelerator& structure, const std::vector<accel::Ray>& rays,
                        std::uint64_t& count) {
  accel::HitBuffer hits(static_cast<int>(rays.size()), 1, 1);
  structure.closest_hits({rays}, hits, nullptr);
  count += rays.size();
  return hits;
}

}  // namespace

/// How a ray came about.
struct Whitted::Path {
  double weight = 1.0;  ///< the largest part that it can have in the pixel's color
  bool inside = false;  ///< in something transparent
};

/// A part of a wave: rays of one depth, and what they found.
struct Whitted::Part {
  std::span<const accel::Ray> rays;
  std::span<const std::optional<accel::Hit>> hits;
  std::span<const Path> paths;

  std::size_t size() const { return rays.size(); }
  Part from(std::size_t first, std::size_t count) const {
    return {rays.subspan(first, count), hits.subspan(first, count), paths.subspan(first, count)};
  }
};

/// Where a ray meets a surface.
struct Whitted::Place {
  const scenes::Surface* surface;
  const scenes::Primitive* primitive;
  dvec3 point;
  dvec3 beside;     ///< a little before the surface: where rays begin
  dvec3 incoming;   ///< unit length
  dvec3 geometric;  ///< unit normals on the side of the ray
  dvec3 shading;
};

/// The next wave, in the order of the places that it comes from: of each the mirror ray first.
struct Whitted::Spawned {
  struct Origin {
    std::size_t place;
    double share;  ///< of its light in that of its place
  };
  std::vector<accel::Ray> rays;
  std::vector<std::optional<accel::Hit>> hits;
  std::vector<Path> paths;
  std::vector<Origin> origins;
};

Whitted::Whitted(const scenes::Scene& scene, const Answerers& answerers,
                 const WhittedOptions& options, rays::HitCheck check)
    : scene_(&scene),
      answerers_(answerers),
      check_(std::move(check)),
      options_(options),
      shadows_(scene, *answerers.shadow, options, check_),
      textures_(scene),
      light_colors_(light_colors(scene)),
      background_(background_color(scene)) {
  for (const scenes::Surface& surface : scene.surfaces) {
    auto& known = matte_.emplace_back();
    if (!is_texture(surface.finish)) known = matte(surface, dvec3(surface.color));
  }
}

Whitted::Progress Whitted::begin() const {
  return {ShadowCache(scene_->lights.size(), options_.max_depth), {}};
}

void Whitted::trace_light(std::span<const accel::Ray> rays,
                          std::span<const std::optional<accel::Hit>> hits, std::span<dvec3> colors,
                          Progress& progress) const {
  progress.census.eye += rays.size();
  for (const auto& hit : hits) progress.census.eye_hits += hit ? 1U : 0U;
  const std::vector<Path> paths(rays.size());
  trace_wave({rays, hits, paths}, 1, colors, progress);
}

/// Part by part, each with all that follows from it: what waits is a part of each depth.
void Whitted::trace_wave(const Part& wave, int depth, std::span<dvec3> colors,
                         Progress& progress) const {
  for (std::size_t first = 0; first < wave.size(); first += kPart) {
    const std::size_t count = std::min(kPart, wave.size() - first);
    trace_part(wave.from(first, count), depth, colors.subspan(first, count), progress);
  }
}

void Whitted::trace_part(const Part& part, int depth, std::span<dvec3> colors,
                         Progress& progress) const {
  std::vector<Place> places;
  std::vector<Path> paths;
  std::vector<std::size_t> hit_places;  // in the part
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (!part.hits[i]) {
      colors[i] = background_;
      continue;
    }
    places.push_back(place_of(part.rays[i], *part.hits[i]));
    paths.push_back(part.paths[i]);
    hit_places.push_back(i);
  }
  const std::vector<dvec3> own = lit(places, depth, progress);
  std::vector<dvec3> from_others(places.size(), dvec3(0.0));
  if (depth < options_.max_depth) {
    const Spawned next = spawned(places, paths, progress);
    std::vector<dvec3> next_colors(next.rays.size());
    trace_wave({next.rays, next.hits, next.paths}, depth + 1, next_colors, progress);
    for (std::size_t i = 0; i < next_colors.size(); ++i) {
      from_others[next.origins[i].place] += next.origins[i].share * next_colors[i];
    }
  }
  for (std::size_t i = 0; i < places.size(); ++i) colors[hit_places[i]] = own[i] + from_others[i];
}

Whitted::Place Whitted::place_of(const accel::Ray& ray, const accel::Hit& hit) const {
  check_.require(ray, hit);
  const scenes::Primitive& primitive = scene_->primitives[hit.primitive];
  const dvec3 direction(ray.direction);
  const dvec3 point = dvec3(ray.origin) + double{hit.t} * direction;
  const rays::SurfaceNormals normals = rays::surface_normals(*scene_, ray, hit);
  return {&scene_->surfaces[primitive.surface],
          &primitive,
          point,
          rays::beside_surface(*scene_, point, normals.geometric),
          glm::normalize(direction),
          normals.geometric,
          normals.shading};
}

dvec3 Whitted::matte_of(const Place& at) const {
  const auto& known = matte_[at.primitive->surface];
  return known ? *known : matte(*at.surface, textures_.color_at(*at.surface, at.point));
}

/// What the lights send to the camera from each place.
std::vector<dvec3> Whitted::lit(std::span<const Place> places, int depth,
                                Progress& progress) const {
  std::vector<dvec3> matte(places.size());
  std::ranges::transform(places, matte.begin(), [this](const Place& at) { return matte_of(at); });
  std::vector<dvec3> sums(places.size());
  std::ranges::transform(matte, sums.begin(), [](const dvec3& color) { return kAmbient * color; });
  for (std::size_t light = 0; light < scene_->lights.size(); ++light) {
    add_light(light, places, matte, depth, sums, progress);
  }
  return sums;
}

/// Lights behind the surface get no shadow ray.
void Whitted::add_light(std::size_t light, std::span<const Place> places,
                        std::span<const dvec3> matte, int depth, std::span<dvec3> sums,
                        Progress& progress) const {
  const dvec3 position(scene_->lights[light].position);
  std::vector<accel::Ray> rays;
  std::vector<std::size_t> facing;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Place& at = places[i];
    const dvec3 offset = position - at.beside;
    if (glm::dot(offset, at.geometric) <= 0.0 || glm::dot(offset, at.shading) <= 0.0) continue;
    rays.push_back(ray_from(at.beside, offset));
    rays.back().t_max = 1.0F;
    facing.push_back(i);
  }
  const std::vector<double> parts =
      shadows_.transmitted(rays, light, depth, progress.shadows, progress.census);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (parts[k] == 0.0) continue;
    const Place& at = places[facing[k]];
    const dvec3 to_light = glm::normalize(position - at.beside);
    dvec3 sent = glm::dot(to_light, at.shading) * matte[facing[k]];
    if (const double specular = at.surface->specular; specular != 0.0) {
      sent += specular * phong(at.shading, to_light, -at.incoming, at.surface->shine);
    }
    sums[facing[k]] += parts[k] * light_colors_[light] * sent;
  }
}

/// Mirror rays and refracted ones, traced. At total reflection the mirror ray carries both shares:
/// it is one ray, even where the surface is a mirror as well (SPD, rule 9).
Whitted::Spawned Whitted::spawned(std::span<const Place> places, std::span<const Path> paths,
                                  Progress& progress) const {
  Spawned next;
  std::vector<accel::Ray> mirror_rays, glass_rays;
  std::vector<bool> is_glass;  // of each ray of the wave
  const auto spawn = [&](std::size_t place, double share, bool inside) {
    const Path path{paths[place].weight * share, inside};
    if (path.weight < options_.min_weight) {
      ++progress.census.too_faint;
      return false;
    }
    next.paths.push_back(path);
    next.origins.push_back({place, share});
    return true;
  };
  const auto reflect = [&](std::size_t place, double share) {
    if (!spawn(place, share, paths[place].inside)) return;
    const Place& at = places[place];
    mirror_rays.push_back(
        ray_from(at.beside, mirrored_outward(at.incoming, at.shading, at.geometric)));
    is_glass.push_back(false);
  };
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Place& at = places[i];
    const double glass = std::max(double{at.surface->transmittance}, 0.0);
    const double mirror = std::max(double{at.surface->specular}, 0.0);
    if (glass == 0.0) {
      if (mirror > 0.0) reflect(i, mirror);
      continue;
    }
    const bool entering = enters(at, paths[i]);
    const double index = std::max(double{at.surface->refraction_index}, 1e-3);
    const auto direction =
        refracted_inward(at.incoming, at.shading, at.geometric, entering ? 1.0 / index : index);
    if (!direction) {
      ++progress.census.totally_reflected;
      reflect(i, mirror + glass);
      continue;
    }
    if (mirror > 0.0 || options_.glass_always_mirrors) reflect(i, mirror);
    if (!spawn(i, glass, entering)) continue;
    glass_rays.push_back(
        ray_from(rays::beside_surface(*scene_, at.point, -at.geometric), *direction));
    is_glass.push_back(true);
  }
  const accel::HitBuffer mirror_hits =
      traced(*answerers_.reflected, mirror_rays, progress.census.reflected);
  const accel::HitBuffer glass_hits =
      traced(*answerers_.refracted, glass_rays, progress.census.refracted);
  std::size_t mirrors = 0, glasses = 0;
  for (const bool glass : is_glass) {
    std::size_t& place = glass ? glasses : mirrors;
    next.rays.push_back((glass ? glass_rays : mirror_rays)[place]);
    next.hits.push_back((glass ? glass_hits : mirror_hits).get(place));
    progress.census.secondary_hits += next.hits.back() ? 1U : 0U;
    ++place;
  }
  return next;
}

/// Whether a ray that meets glass goes into it: of a sphere by the place of the point, of polygons
/// and cones by the surfaces that the ray has passed.
bool Whitted::enters(const Place& at, const Path& path) const {
  if (at.primitive->kind != scenes::PrimitiveKind::kSphere) return !path.inside;
  const dvec3 center(scene_->spheres[at.primitive->index].center);
  return glm::dot(at.point - center, at.incoming) < 0.0;
}

}  // namespace beambench::render
