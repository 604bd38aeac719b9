#include "harness/render/whitted.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "accel/core/instruction_set.hpp"
#include "accel/core/primary_rays.hpp"
#include "accel/core/tolerance.hpp"
#include "harness/rays/normal.hpp"
#include "harness/render/pencils.hpp"
#include "harness/render/shading.hpp"

namespace beambench::render {
namespace {

using glm::dvec3;

constexpr double kAmbient = 0.06;  // of white light, from everywhere

static_assert(rays::kMaxPictureBatch / kMinPencil + rays::kMaxPictureBatch / kMinRefracted < kNoEye,
              "each group of a part has an index");

/// Returns a mirror direction on the outer side of the surface, which a smooth polygon's shading
/// normal may miss.
dvec3 mirrored_outward(const dvec3& incoming, const dvec3& shading, const dvec3& geometric) {
  const dvec3 direction = accel::mirrored(incoming, shading);
  return glm::dot(direction, geometric) > 0.0 ? direction : accel::mirrored(incoming, geometric);
}

/// Returns a refracted direction on the inner side of the surface, which a shading normal may also
/// miss.
std::optional<dvec3> refracted_inward(const dvec3& incoming, const dvec3& shading,
                                      const dvec3& geometric, double ratio) {
  const auto direction = refracted(incoming, shading, ratio);
  const bool outward = direction && glm::dot(*direction, geometric) >= 0.0;
  return outward ? refracted(incoming, geometric, ratio) : direction;
}

/// Adds a ray, constructed in place: copying a newly made ray would wait until it is in memory.
accel::Ray& add_ray(std::vector<accel::Ray>& rays, const dvec3& origin, const dvec3& direction) {
  accel::Ray& ray = rays.emplace_back();
  ray.origin = glm::vec3(origin);
  ray.direction = glm::vec3(direction);
  return ray;
}

/// Traces a batch of rays and counts the hits.
accel::HitBuffer traced(const accel::Accelerator& structure, const accel::RayBatch& batch,
                        std::uint64_t& count) {
  accel::HitBuffer hits(static_cast<int>(batch.rays.size()), 1, 1);
  if (!batch.rays.empty()) structure.closest_hits(batch, hits, {});
  count += batch.rays.size();
  return hits;
}

/// Merges the values of mirror rays and of glass rays in the order of the wave.
template <class Value>
std::vector<Value> merged(std::vector<Value> mirrors, const std::vector<Value>& glasses,
                          const std::vector<bool>& is_glass) {
  if (glasses.empty()) return mirrors;
  std::vector<Value> all;
  all.reserve(is_glass.size());
  auto mirror = mirrors.begin();
  auto glass = glasses.begin();
  for (const bool is : is_glass) all.push_back(is ? *glass++ : *mirror++);
  return all;
}

}  // namespace

/// The history of a ray.
struct Whitted::Path {
  double weight;  ///< its maximum contribution to the pixel's color
  EyeIndex eye;   ///< among the eyes of its wave
  bool inside;    ///< whether it is inside something transparent
};

/// A part of a wave: rays of one depth, and their hits.
struct Whitted::Part {
  std::span<const accel::Ray> rays;
  std::span<const std::uint32_t> samples;
  std::span<const std::optional<accel::Hit>> hits;
  std::span<const Path> paths;
  std::span<const Eye> eyes;  ///< the eyes of the whole wave
  const accel::PrimaryRays* image;

  std::size_t size() const { return rays.size(); }
  Part from(std::size_t first, std::size_t count) const {
    return {rays.subspan(first, count),
            samples.subspan(first, count),
            hits.subspan(first, count),
            paths.subspan(first, count),
            eyes,
            image};
  }
};

/// The rays of a part that hit: the place and the primitive of each hit, and the rays' histories.
struct Whitted::Found {
  explicit Found(std::size_t count)
      : places(count), ray(count), sample(count), primitive(count), surface(count), path(count) {}

  std::size_t size() const { return places.size; }

  Places places;
  std::vector<std::size_t> ray;  ///< its index in the part
  std::vector<std::uint32_t> sample;
  std::vector<scenes::PrimitiveId> primitive;
  std::vector<std::uint32_t> surface;
  std::vector<Path> path;
};

/// The next wave, in the order of the places from which its rays come; at each place, the mirror
/// ray comes first.
struct Whitted::Spawned {
  struct Origin {
    std::size_t place;
    double share;  ///< the ray's share of the light of its place
  };
  std::vector<accel::Ray> rays;
  std::vector<std::uint32_t> samples;
  std::vector<std::optional<accel::Hit>> hits;
  std::vector<Path> paths;
  std::vector<Origin> origins;
  std::vector<Eye> eyes;
};

Whitted::Whitted(std::shared_ptr<const ShadedScene> scene, const RayStructures& structures,
                 const WhittedOptions& options, rays::HitCheck check)
    : shaded_(std::move(scene)),
      scene_(&shaded_->scene()),
      structures_(structures),
      check_(std::move(check)),
      options_(options),
      shadows_(*scene_, *structures.shadow, options, check_),
      kernels_(&place_kernels(accel::targets_of("best"))) {}

Whitted::Progress Whitted::begin() const {
  return {ShadowCache(scene_->lights.size(), options_.max_depth), {}};
}

void Whitted::trace_light(const CameraRays& camera, std::span<dvec3> colors,
                          Progress& progress) const {
  progress.census.eye += camera.rays.size();
  for (const auto& hit : camera.hits) progress.census.eye_hits += hit ? 1U : 0U;
  const std::vector<Path> paths(camera.rays.size(), {1.0, 0, false});
  const Eye eye(*camera.image);
  trace_wave({camera.rays, camera.samples, camera.hits, paths, {&eye, 1}, camera.image}, 1, colors,
             progress);
}

/// Traces part by part, each with all rays that follow from it, so one part is waiting at each
/// depth. A waiting part needs about 210 bytes for each of its rays that hit, and 100 for each ray
/// spawned. The part being traced needs about 200 bytes more per ray, besides the structure's own
/// memory.
void Whitted::trace_wave(const Part& wave, int depth, std::span<dvec3> colors,
                         Progress& progress) const {
  const auto batch = static_cast<std::size_t>(options_.batch);
  for (std::size_t first = 0; first < wave.size(); first += batch) {
    const std::size_t count = std::min(batch, wave.size() - first);
    trace_part(wave.from(first, count), depth, colors.subspan(first, count), progress);
  }
}

void Whitted::trace_part(const Part& part, int depth, std::span<dvec3> colors,
                         Progress& progress) const {
  std::ranges::fill(colors, shaded_->background());
  const Found found = find_places(part);
  const std::vector<dvec3> own = lit(found, *part.image, depth, progress);
  std::vector<dvec3> from_others(found.size(), dvec3(0.0));
  if (depth < options_.max_depth) {
    const Spawned next = spawned(found, part, progress);
    std::vector<dvec3> next_colors(next.rays.size());
    trace_wave({next.rays, next.samples, next.hits, next.paths, next.eyes, part.image}, depth + 1,
               next_colors, progress);
    for (std::size_t i = 0; i < next_colors.size(); ++i) {
      from_others[next.origins[i].place] += next.origins[i].share * next_colors[i];
    }
  }
  for (std::size_t i = 0; i < found.size(); ++i) colors[found.ray[i]] = own[i] + from_others[i];
}

Whitted::Found Whitted::find_places(const Part& part) const {
  const auto is_hit = [](const auto& hit) { return hit.has_value(); };
  Found found(static_cast<std::size_t>(std::ranges::count_if(part.hits, is_hit)));
  Places& places = found.places;
  std::size_t place = 0;
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (!part.hits[i]) continue;
    const accel::Hit& hit = *part.hits[i];
    const accel::Ray& ray = part.rays[i];
    check_.require(ray, hit);
    const dvec3 direction(ray.direction);
    const dvec3 point = dvec3(ray.origin) + double{hit.t} * direction;
    const rays::SurfaceNormals normals =
        rays::surface_normals(*scene_, hit.primitive, point, shaded_->normals());
    places.point.set(place, point);
    places.lift[place] = shaded_->mirrors().lift_at(hit.primitive, dvec3(ray.origin), point);
    places.incoming.set(place, direction);
    places.geometric.set(place, normals.geometric);
    places.shading.set(place, normals.shading);
    found.ray[place] = i;
    found.sample[place] = part.samples[i];
    found.primitive[place] = hit.primitive;
    found.surface[place] = scene_->primitives[hit.primitive].surface;
    found.path[place] = part.paths[i];
    ++place;
  }
  kernels_->complete(places);
  return found;
}

/// Returns the light reflected to the camera from each place.
std::vector<dvec3> Whitted::lit(const Found& found, const accel::PrimaryRays& image, int depth,
                                Progress& progress) const {
  std::vector<dvec3> matte(found.size());
  std::vector<dvec3> sums(found.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    matte[i] = shaded_->matte_at(found.surface[i], found.places.point[i]);
    sums[i] = kAmbient * matte[i];
  }
  for (std::size_t light = 0; light < scene_->lights.size(); ++light) {
    add_light(light, found, matte, image, depth, sums, progress);
  }
  return sums;
}

/// Adds the light of one light source. A light behind the surface gets no shadow ray.
void Whitted::add_light(std::size_t light, const Found& found, std::span<const dvec3> matte,
                        const accel::PrimaryRays& image, int depth, std::span<dvec3> sums,
                        Progress& progress) const {
  const dvec3 position(scene_->lights[light].position);
  LightAngles angles(found.size());
  kernels_->find_angles(found.places, position, angles);
  std::vector<accel::Ray> rays;
  std::vector<std::size_t> places;
  rays.reserve(found.size());
  places.reserve(found.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (angles.is_before[i] == 0.0) continue;
    const dvec3 beside = found.places.beside[i];
    add_ray(rays, beside, position - beside).t_max = accel::t_before_light(beside, position);
    places.push_back(i);
  }
  std::vector<std::uint32_t> samples(places.size());
  for (std::size_t k = 0; k < places.size(); ++k) samples[k] = found.sample[places[k]];
  const std::vector<double> parts = shadows_.transmitted({rays, {}, samples, &image}, light, depth,
                                                         progress.shadows, progress.census);
  const dvec3 color = shaded_->light_colors()[light];
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (parts[k] == 0.0) continue;
    const std::size_t i = places[k];
    const scenes::Surface& surface = scene_->surfaces[found.surface[i]];
    dvec3 sent = angles.cosine[i] * matte[i];
    if (surface.specular != 0.0F) {
      sent += double{surface.specular} * phong(angles.gleam[i], surface.shine);
    }
    sums[i] += parts[k] * color * sent;
  }
}

/// Returns the mirror rays and refracted rays, already traced. At total reflection the mirror ray
/// carries both shares: it is one ray, even if the surface is also a mirror (SPD, rule 9).
Whitted::Spawned Whitted::spawned(const Found& found, const Part& part, Progress& progress) const {
  Spawned next;
  std::vector<accel::Ray> mirror_rays, glass_rays;
  std::vector<std::uint32_t> mirror_samples, glass_samples;
  std::vector<bool> is_glass;  // for each ray of the wave
  PlaneGroups mirror_groups(Turn::kReflected, shaded_->mirrors(), part.eyes);
  PlaneGroups glass_groups(Turn::kRefracted, shaded_->glass(), part.eyes);
  mirror_rays.reserve(found.size());
  mirror_samples.reserve(found.size());
  next.paths.reserve(found.size());
  next.origins.reserve(found.size());
  const Places& places = found.places;
  const auto spawn = [&](std::size_t place, double share, bool inside) {
    const double weight = found.path[place].weight * share;
    if (weight < options_.min_weight) {
      ++progress.census.too_faint;
      return false;
    }
    next.paths.emplace_back(weight, kNoEye, inside);
    next.origins.emplace_back(place, share);
    return true;
  };
  const auto reflect = [&](std::size_t place, double share) {
    if (!spawn(place, share, found.path[place].inside)) return;
    add_ray(
        mirror_rays, places.beside[place],
        mirrored_outward(places.incoming[place], places.shading[place], places.geometric[place]));
    mirror_samples.push_back(found.sample[place]);
    mirror_groups.add(found.path[place].eye, found.primitive[place]);
    is_glass.push_back(false);
  };
  for (std::size_t i = 0; i < found.size(); ++i) {
    const scenes::Surface& surface = scene_->surfaces[found.surface[i]];
    const double glass = std::max(double{surface.transmittance}, 0.0);
    const double mirror = std::max(double{surface.specular}, 0.0);
    if (glass == 0.0) {
      if (mirror > 0.0) reflect(i, mirror);
      continue;
    }
    const bool entering = enters(found, i);
    const double index = std::max(double{surface.refraction_index}, 1e-3);
    const auto direction = refracted_inward(places.incoming[i], places.shading[i],
                                            places.geometric[i], entering ? 1.0 / index : index);
    if (!direction) {
      ++progress.census.totally_reflected;
      reflect(i, mirror + glass);
      continue;
    }
    if (mirror > 0.0 || options_.glass_always_mirrors) reflect(i, mirror);
    if (!spawn(i, glass, entering)) continue;
    add_ray(glass_rays, places.point[i] - places.lift[i] * places.geometric[i], *direction);
    glass_samples.push_back(found.sample[i]);
    glass_groups.add(found.path[i].eye, found.primitive[i]);
    is_glass.push_back(true);
  }
  const accel::HitBuffer mirror_hits = traced(
      *structures_.reflected, mirror_groups.arranged({mirror_rays, {}, mirror_samples, part.image}),
      progress.census.reflected);
  const accel::HitBuffer glass_hits = traced(
      *structures_.refracted, glass_groups.arranged({glass_rays, {}, glass_samples, part.image}),
      progress.census.refracted);
  next.eyes = mirror_groups.eyes();
  const auto before_glass = static_cast<EyeIndex>(next.eyes.size());
  next.eyes.insert(next.eyes.end(), glass_groups.eyes().begin(), glass_groups.eyes().end());
  next.hits.reserve(is_glass.size());
  std::size_t mirrors = 0, glasses = 0;
  for (std::size_t i = 0; i < is_glass.size(); ++i) {
    if (is_glass[i]) {
      const EyeIndex eye = glass_groups.eye_of(glasses);
      if (eye != kNoEye) next.paths[i].eye = static_cast<EyeIndex>(before_glass + eye);
      next.hits.push_back(glass_hits.get(glass_groups.place_of(glasses++)));
    } else {
      next.paths[i].eye = mirror_groups.eye_of(mirrors);
      next.hits.push_back(mirror_hits.get(mirror_groups.place_of(mirrors++)));
    }
    progress.census.secondary_hits += next.hits.back() ? 1U : 0U;
  }
  next.rays = merged(std::move(mirror_rays), glass_rays, is_glass);
  next.samples = merged(std::move(mirror_samples), glass_samples, is_glass);
  return next;
}

/// Returns whether a ray that meets glass enters it: for a sphere judging by the position of the
/// point, for polygons and cones by the surfaces that the ray has passed.
bool Whitted::enters(const Found& found, std::size_t place) const {
  const scenes::Primitive& primitive = scene_->primitives[found.primitive[place]];
  if (primitive.kind != scenes::PrimitiveKind::kSphere) return !found.path[place].inside;
  const dvec3 center(scene_->spheres[primitive.index].center);
  return glm::dot(found.places.point[place] - center, found.places.incoming[place]) < 0.0;
}

}  // namespace beambench::render
