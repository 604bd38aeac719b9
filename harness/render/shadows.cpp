#include "harness/render/shadows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "accel/core/hit_buffer.hpp"
#include "accel/core/intersect.hpp"
#include "accel/core/tolerance.hpp"
#include "harness/base/messages.hpp"
#include "harness/render/pencils.hpp"

namespace beambench::render {
namespace {

constexpr std::array<std::string_view, 3> kMethodNames{"rays", "cache", "light-buffer"};

using glm::dvec3;

/// A box, relative to the light.
struct LitBox {
  dvec3 low;
  dvec3 high;
};

/// Returns a primitive's box, widened to cover all rounding: a hit may lie beside its primitive,
/// and a shadow ray, whose coordinates are floats, beside the straight line to the light.
LitBox lit_box(const scenes::Scene& scene, scenes::PrimitiveId id, const dvec3& light) {
  const double size = scene.bounds.largest_coordinate() + glm::length(light);
  const double slack = accel::overlap_tolerance(scene) + 0x1p-20 * size;
  const scenes::Bounds bounds = scenes::primitive_bounds(scene, id);
  return {dvec3(bounds.lower) - light - slack, dvec3(bounds.upper) - light + slack};
}

double distance_to(const LitBox& box) {
  return glm::length(glm::max(glm::max(box.low, -box.high), dvec3(0.0)));
}

struct Range {
  double low;
  double high;
};

/// Returns the smallest magnitude in a range.
double min_magnitude(const Range& range) { return std::max({range.low, -range.high, 0.0}); }

/// Returns the part of a face, [-1, 1], covered by a range of one coordinate divided by a range of
/// depths.
Range projected(const Range& range, const Range& depth) {
  if (depth.low <= 0.0) return {-1.0, 1.0};  // the light is in the box's shadow on this face
  return {std::max(range.low / (range.low < 0.0 ? depth.low : depth.high), -1.0),
          std::min(range.high / (range.high > 0.0 ? depth.low : depth.high), 1.0)};
}

int cell_at(double place, int cells) {
  return std::clamp(static_cast<int>(std::floor((place + 1.0) * 0.5 * cells)), 0, cells - 1);
}

std::size_t cell_index(int face, int u, int v, int cells) {
  return (static_cast<std::size_t>(face) * static_cast<std::size_t>(cells) +
          static_cast<std::size_t>(v)) *
             static_cast<std::size_t>(cells) +
         static_cast<std::size_t>(u);
}

/// Calls `visit(cell)` for all cells through which a box may be visible.
template <class Visit>
void visit_cells(const LitBox& box, int cells, Visit visit) {
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const Range along = face % 2 == 0 ? Range{box.low[axis], box.high[axis]}
                                      : Range{-box.high[axis], -box.low[axis]};
    if (along.high <= 0.0) continue;
    const Range u_range{box.low[(axis + 1) % 3], box.high[(axis + 1) % 3]};
    const Range v_range{box.low[(axis + 2) % 3], box.high[(axis + 2) % 3]};
    // Only parts whose depth exceeds their lateral distance are seen through this face.
    const Range depth{std::max({along.low, min_magnitude(u_range), min_magnitude(v_range)}),
                      along.high};
    if (depth.low > depth.high) continue;
    const Range u = projected(u_range, depth);
    const Range v = projected(v_range, depth);
    if (u.low > u.high || v.low > v.high) continue;
    for (int row = cell_at(v.low, cells); row <= cell_at(v.high, cells); ++row) {
      for (int column = cell_at(u.low, cells); column <= cell_at(u.high, cells); ++column) {
        visit(cell_index(face, column, row, cells));
      }
    }
  }
}

/// Cells along an edge of a light buffer.
constexpr int kBufferCells = 128;

float transmittance_of(const scenes::Scene& scene, scenes::PrimitiveId id) {
  return scene.surfaces[scene.primitives[id].surface].transmittance;
}

}  // namespace

std::span<const std::string_view> shadow_method_names() { return kMethodNames; }

ShadowMethod parse_shadow_method(std::string_view name) {
  return static_cast<ShadowMethod>(base::place_of_name("shadow method", name, kMethodNames));
}

WhittedOptions whitted_options(const rays::RayChoice& choice) {
  const Parameters parameters = rays::parameters_of(choice);
  return {static_cast<int>(parameters.integer("depth")), parameters.real("least_weight"),
          parse_shadow_method(parameters.choice("shadows")),
          static_cast<int>(parameters.integer("batch"))};
}

LightBuffer::LightBuffer(const scenes::Scene& scene, const glm::vec3& light, int cells)
    : scene_(&scene), light_(light), cells_(cells), first_(cell_index(6, 0, 0, cells) + 1) {
  const auto count = static_cast<scenes::PrimitiveId>(scene.primitives.size());
  for (scenes::PrimitiveId id = 0; id < count; ++id) {
    visit_cells(lit_box(scene, id, light_), cells, [&](std::size_t cell) { ++first_[cell + 1]; });
  }
  for (std::size_t cell = 1; cell < first_.size(); ++cell) first_[cell] += first_[cell - 1];
  entries_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (scenes::PrimitiveId id = 0; id < count; ++id) {
    const LitBox box = lit_box(scene, id, light_);
    const double near = distance_to(box);
    visit_cells(box, cells, [&](std::size_t cell) { entries_[next[cell]++] = {near, id}; });
  }
  for (std::size_t cell = 0; cell + 1 < first_.size(); ++cell) {
    std::sort(entries_.begin() + first_[cell], entries_.begin() + first_[cell + 1],
              [](const Entry& a, const Entry& b) {
                return a.near != b.near ? a.near < b.near : a.primitive < b.primitive;
              });
  }
}

std::size_t LightBuffer::cell_of(const dvec3& direction) const {
  const dvec3 size = glm::abs(direction);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  const int face = 2 * axis + (direction[axis] < 0.0 ? 1 : 0);
  const double depth = size[axis] > 0.0 ? size[axis] : 1.0;
  return cell_index(face, cell_at(direction[(axis + 1) % 3] / depth, cells_),
                    cell_at(direction[(axis + 2) % 3] / depth, cells_), cells_);
}

LightBuffer::Visibility LightBuffer::visibility(const accel::Ray& to_light,
                                                std::uint64_t& tests) const {
  const dvec3 from_light = dvec3(to_light.origin) - light_;
  const double distance = glm::length(from_light);
  const std::size_t cell = cell_of(from_light);
  const accel::CanonicalRay ray(to_light);
  Visibility found = Visibility::kFree;
  for (std::size_t i = first_[cell]; i < first_[cell + 1] && entries_[i].near <= distance; ++i) {
    ++tests;
    const scenes::PrimitiveId id = entries_[i].primitive;
    if (!accel::is_hit(accel::intersect(ray, *scene_, id))) continue;
    if (transmittance_of(*scene_, id) <= 0.0F) return Visibility::kHidden;
    found = Visibility::kTransparent;
  }
  return found;
}

std::size_t LightBuffer::memory_bytes() const {
  return sizeof(*this) + first_.capacity() * sizeof(first_[0]) +
         entries_.capacity() * sizeof(entries_[0]);
}

Shadows::Shadows(const scenes::Scene& scene, const accel::Accelerator& structure,
                 const WhittedOptions& options, rays::HitCheck check)
    : scene_(&scene),
      structure_(&structure),
      check_(std::move(check)),
      method_(options.shadows),
      all_opaque_(std::none_of(scene.surfaces.begin(), scene.surfaces.end(),
                               [](const scenes::Surface& s) { return s.transmittance > 0.0F; })) {
  if (method_ != ShadowMethod::kLightBuffer) return;
  buffers_.reserve(scene.lights.size());
  for (const scenes::Light& light : scene.lights) {
    buffers_.emplace_back(scene, light.position, kBufferCells);
  }
}

std::vector<double> Shadows::transmitted(const accel::RayBatch& to_light, std::size_t light,
                                         int depth, ShadowCache& cache, RayCensus& census) const {
  std::vector<double> parts;
  switch (method_) {
    case ShadowMethod::kRays:
      parts =
          all_opaque_ ? asked_at_once(to_light, light, census) : followed(to_light, light, census);
      break;
    case ShadowMethod::kCache: {
      const std::size_t row = static_cast<std::size_t>(depth - 1) * scene_->lights.size();
      for (const accel::Ray& ray : to_light.rays) {
        parts.push_back(asked_by_cache(ray, cache.last[row + light], census));
      }
      break;
    }
    case ShadowMethod::kLightBuffer:
      for (const accel::Ray& ray : to_light.rays)
        parts.push_back(asked_by_buffer(ray, light, census));
      break;
  }
  census.shadow += to_light.rays.size();
  census.shadow_hidden += static_cast<std::uint64_t>(std::ranges::count(parts, 0.0));
  return parts;
}

std::vector<accel::Pencil> Shadows::pencil(std::size_t light, std::size_t rays) const {
  if (rays < kMinPencil) return {};
  return {{0, rays, dvec3(scene_->lights[light].position), true}};
}

std::vector<double> Shadows::asked_at_once(const accel::RayBatch& to_light, std::size_t light,
                                           RayCensus& census) const {
  const std::size_t count = to_light.rays.size();
  std::vector<std::uint8_t> hidden(count);
  const std::vector<accel::Pencil> pencils = pencil(light, count);
  if (count > 0) {
    structure_->any_hits(accel::RayBatch{to_light.rays, pencils, to_light.samples, to_light.image},
                         hidden, {});
  }
  census.shadow_queries += count;
  std::vector<double> parts(count);
  std::ranges::transform(hidden, parts.begin(), [](std::uint8_t hit) { return hit ? 0.0 : 1.0; });
  return parts;
}

double Shadows::asked_by_cache(const accel::Ray& to_light, scenes::PrimitiveId& last,
                               RayCensus& census) const {
  if (last != scenes::kNoPrimitive) {
    ++census.shadow_tests;
    if (accel::is_hit(accel::intersect(accel::CanonicalRay(to_light), *scene_, last))) {
      ++census.shadow_cached;
      return 0.0;
    }
  }
  if (all_opaque_) {
    ++census.shadow_queries;
    if (!structure_->any_hit(to_light, nullptr)) return 1.0;
  }
  return followed(to_light, last, census);  // any_hit does not return the primitive
}

double Shadows::asked_by_buffer(const accel::Ray& to_light, std::size_t light,
                                RayCensus& census) const {
  const LightBuffer::Visibility found = buffers_[light].visibility(to_light, census.shadow_tests);
  if (found == LightBuffer::Visibility::kTransparent) {
    scenes::PrimitiveId unused = scenes::kNoPrimitive;
    return followed(to_light, unused, census);
  }
  ++census.shadow_listed;
  return found == LightBuffer::Visibility::kHidden ? 0.0 : 1.0;
}

/// Follows the rays from surface to surface, each time starting slightly behind the surface, as all
/// rays begin slightly beside surfaces. An additional any-hit query at the beginning made pictures
/// of `gears`, `mount` and `finishes` take 1% to 25% longer.
std::vector<double> Shadows::followed(const accel::RayBatch& to_light, std::size_t light,
                                      RayCensus& census) const {
  std::vector<accel::Ray> rays(to_light.rays.begin(), to_light.rays.end());
  std::vector<std::uint32_t> samples(to_light.samples.begin(), to_light.samples.end());
  std::vector<double> parts(rays.size(), 1.0);
  std::vector<std::size_t> places(rays.size());  // of the rays still followed, in `parts`
  std::iota(places.begin(), places.end(), std::size_t{0});
  while (!rays.empty()) {
    accel::HitBuffer hits(static_cast<int>(rays.size()), 1, 1);
    const std::vector<accel::Pencil> pencils = pencil(light, rays.size());
    structure_->closest_hits(accel::RayBatch{rays, pencils, samples, to_light.image}, hits, {});
    census.shadow_queries += rays.size();
    std::size_t left = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const std::optional<accel::Hit> hit = hits.get(i);
      if (!hit) continue;
      double& part = parts[places[i]];
      part *= passed_through(rays[i], *hit);
      if (part == 0.0 || rays[i].t_min > rays[i].t_max) continue;
      rays[left] = rays[i];
      samples[left] = samples[i];
      places[left++] = places[i];
    }
    rays.resize(left);
    samples.resize(left);
    places.resize(left);
  }
  return parts;
}

/// Follows one ray; if an opaque surface ends it, its primitive becomes the `blocker`.
double Shadows::followed(accel::Ray ray, scenes::PrimitiveId& blocker, RayCensus& census) const {
  double part = 1.0;
  while (ray.t_min <= ray.t_max) {
    ++census.shadow_queries;
    const std::optional<accel::Hit> hit = structure_->closest_hit(ray, nullptr);
    if (!hit) return part;
    part *= passed_through(ray, *hit);
    if (part == 0.0) {
      blocker = hit->primitive;
      return 0.0;
    }
  }
  return part;
}

/// Returns the transmittance of the surface that a ray has met; 0 if it is opaque. Moves the ray's
/// origin behind the surface.
float Shadows::passed_through(accel::Ray& ray, const accel::Hit& hit) const {
  check_.require(ray, hit);
  const float through = std::max(transmittance_of(*scene_, hit.primitive), 0.0F);
  const dvec3 origin(ray.origin);
  const dvec3 direction(ray.direction);
  const double lift = accel::surface_lift(origin, origin + double{hit.t} * direction);
  ray.t_min = static_cast<float>(hit.t + lift / glm::length(direction));
  return through;
}

std::size_t Shadows::memory_bytes() const {
  std::size_t bytes = 0;
  for (const LightBuffer& buffer : buffers_) bytes += buffer.memory_bytes();
  return bytes;
}

}  // namespace beambench::render
