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

}  // namespace

/// The structure that traces a kind of rays, and where it is counted.
struct Whitted::Kind {
  const accel::Accelerator* Answerers::*answerer;
  std::uint64_t RayCensus::*count;
};

/// How a ray came about.
struct Whitted::Path {
  int depth = 1;        ///< rays from the camera to here
  double weight = 1.0;  ///< the largest part that it can have in the pixel's color
  bool inside = false;  ///< in something transparent
};

/// Where a ray meets a surface.
struct Whitted::Place {
  const scenes::Surface* surface;
  const scenes::Primitive* primitive;
  dvec3 point;
  dvec3 incoming;   ///< unit length
  dvec3 geometric;  ///< unit normals on the side of the ray
  dvec3 shading;
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
      background_(background_color(scene)) {}

Whitted::Progress Whitted::begin() const {
  return {ShadowCache(scene_->lights.size(), options_.max_depth), {}};
}

dvec3 Whitted::camera_ray_color(const accel::Ray& ray, const std::optional<accel::Hit>& hit,
                                Progress& progress) const {
  ++progress.census.eye;
  if (hit) ++progress.census.eye_hits;
  return color_along(ray, hit, {}, progress);
}

dvec3 Whitted::color_along(const accel::Ray& ray, const std::optional<accel::Hit>& hit,
                           const Path& path, Progress& progress) const {
  if (!hit) return background_;
  const Place at = place_of(ray, *hit);
  return lit(at, path, progress) + spawned(at, path, progress);
}

/// Along the mirror ray and the refracted one. At total reflection the mirror ray carries both
/// shares: it is one ray, even where the surface is a mirror as well (SPD, rule 9).
dvec3 Whitted::spawned(const Place& at, const Path& path, Progress& progress) const {
  const double glass = std::max(double{at.surface->transmittance}, 0.0);
  const double mirror = std::max(double{at.surface->specular}, 0.0);
  if (glass == 0.0) return mirror > 0.0 ? reflected(at, path, mirror, progress) : dvec3(0.0);
  const bool entering = enters(at, path);
  const double index = std::max(double{at.surface->refraction_index}, 1e-3);
  const auto direction =
      refracted_inward(at.incoming, at.shading, at.geometric, entering ? 1.0 / index : index);
  if (!direction) {
    if (path.depth < options_.max_depth) ++progress.census.totally_reflected;
    return reflected(at, path, mirror + glass, progress);
  }
  const bool mirrors = mirror > 0.0 || options_.glass_always_mirrors;
  const dvec3 before = mirrors ? reflected(at, path, mirror, progress) : dvec3(0.0);
  const Path next{path.depth + 1, path.weight * glass, entering};
  constexpr Kind kRefracted{&Answerers::refracted, &RayCensus::refracted};
  return before + glass * traced(kRefracted, rays::beside_surface(*scene_, at.point, -at.geometric),
                                 *direction, next, progress);
}

Whitted::Place Whitted::place_of(const accel::Ray& ray, const accel::Hit& hit) const {
  check_.require(ray, hit);
  const scenes::Primitive& primitive = scene_->primitives[hit.primitive];
  const dvec3 direction(ray.direction);
  return {&scene_->surfaces[primitive.surface],          &primitive,
          dvec3(ray.origin) + double{hit.t} * direction, glm::normalize(direction),
          rays::geometric_normal(*scene_, ray, hit),     rays::shading_normal(*scene_, ray, hit)};
}

/// What the lights send to the camera from here. Lights behind the surface get no shadow ray.
dvec3 Whitted::lit(const Place& at, const Path& path, Progress& progress) const {
  const scenes::Surface& surface = *at.surface;
  const dvec3 display = glm::clamp(textures_.color_at(surface, at.point), 0.0, 1.0);
  const dvec3 matte = double{surface.diffuse} * dvec3(linear_from_srgb(glm::vec3(display)));
  const dvec3 origin = rays::beside_surface(*scene_, at.point, at.geometric);
  dvec3 sum = kAmbient * matte;
  for (std::size_t i = 0; i < scene_->lights.size(); ++i) {
    const dvec3 offset = dvec3(scene_->lights[i].position) - origin;
    if (glm::dot(offset, at.geometric) <= 0.0 || glm::dot(offset, at.shading) <= 0.0) continue;
    accel::Ray ray;
    ray.origin = glm::vec3(origin);
    ray.direction = glm::vec3(offset);
    ray.t_max = 1.0F;
    const double part = shadows_.transmitted(ray, i, path.depth, progress.shadows, progress.census);
    if (part == 0.0) continue;
    const dvec3 to_light = glm::normalize(offset);
    sum += part * light_colors_[i] *
           (glm::dot(to_light, at.shading) * matte +
            surface.specular * phong(at.shading, to_light, -at.incoming, surface.shine));
  }
  return sum;
}

dvec3 Whitted::reflected(const Place& at, const Path& path, double share,
                         Progress& progress) const {
  const Path next{path.depth + 1, path.weight * share, path.inside};
  constexpr Kind kReflected{&Answerers::reflected, &RayCensus::reflected};
  return share * traced(kReflected, rays::beside_surface(*scene_, at.point, at.geometric),
                        mirrored_outward(at.incoming, at.shading, at.geometric), next, progress);
}

/// Whether a ray that meets glass goes into it: of a sphere by the place of the point, of polygons
/// and cones by the surfaces that the ray has passed.
bool Whitted::enters(const Place& at, const Path& path) const {
  if (at.primitive->kind != scenes::PrimitiveKind::kSphere) return !path.inside;
  const dvec3 center(scene_->spheres[at.primitive->index].center);
  return glm::dot(at.point - center, at.incoming) < 0.0;
}

dvec3 Whitted::traced(const Kind& kind, const dvec3& origin, const dvec3& direction,
                      const Path& path, Progress& progress) const {
  if (path.depth > options_.max_depth) return dvec3(0.0);
  if (path.weight < options_.min_weight) {
    ++progress.census.too_faint;
    return dvec3(0.0);
  }
  accel::Ray ray;
  ray.origin = glm::vec3(origin);
  ray.direction = glm::vec3(direction);
  ++(progress.census.*kind.count);
  const std::optional<accel::Hit> hit = (answerers_.*kind.answerer)->closest_hit(ray, nullptr);
  if (hit) ++progress.census.secondary_hits;
  return color_along(ray, hit, path, progress);
}

}  // namespace beambench::render
