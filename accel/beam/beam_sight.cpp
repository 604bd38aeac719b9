#include "accel/beam/beam_sight.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "accel/core/tolerance.hpp"

namespace beambench::accel::beam {
namespace {

using glm::dvec3;

/// A beam with fewer samples becomes single rays. By the thesis's rule, beams of the image itself
/// never do, but the beams of a mirror can have few samples: 8,000 beams had only 500. This was the
/// fastest value of 0, 4, 8, 16, 32 and 64 on ajedrez, closed-room and habitacion.
constexpr std::int64_t kSmallBeam = 8;
/// The maximum number of pixels per ray of the pencil; for sparser parts, the buffers would cost
/// too much.
constexpr std::size_t kSparsest = 64;

/// Returns a convex cover of pixels, given by their corners: the image, cut along lines of 16
/// directions.
ImagePolygon cover(const std::vector<glm::dvec2>& corners) {
  ImagePolygon part;
  if (corners.empty()) return part;
  for (const glm::dvec2 corner :
       {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(1, 1), glm::dvec2(0, 1)}) {
    part.push_back(corner);
  }
  constexpr int kDirections = 16;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kDirections;
    const glm::dvec2 axis(std::cos(angle), std::sin(angle));
    double farthest = -1e30;
    for (const glm::dvec2& corner : corners) farthest = std::max(farthest, glm::dot(corner, axis));
    part = clip(part, {axis.x, axis.y, -farthest, 0.0}, 1e-9);
  }
  return part;
}

/// Returns the coordinate of a box's highest corner in a direction.
double highest(const dvec3& direction, const dvec3& lower, const dvec3& upper) {
  return glm::dot(direction, glm::mix(lower, upper, glm::greaterThan(direction, dvec3(0.0))));
}

}  // namespace

BehindPlane::BehindPlane(std::span<const Ray> rays, std::span<const std::uint32_t> samples,
                         const DriftingView& view, double limit, const scenes::Scene& scene,
                         const octree::Octree& octree)
    : scene_(&scene),
      octree_(&octree),
      view_(&view.image),
      rays_(rays),
      samples_(samples),
      places_(rays.size(), kNone) {
  choose_part();
  take_rays(view, limit);
  find_plane();
}

void BehindPlane::choose_part() {
  glm::ivec2 first(view_->width(), view_->height());
  glm::ivec2 last(-1);
  for (const std::uint32_t sample : samples_) {
    const glm::ivec2 pixel = place_in(*view_, sample).pixel;
    first = glm::min(first, pixel);
    last = glm::max(last, pixel);
  }
  const glm::ivec2 size = last - first + 1;
  const auto area = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
  if (area > kSparsest * rays_.size()) return;
  corner_ = first;
  size_ = size;
  ray_at_.assign(area * static_cast<std::size_t>(view_->samples()), kNone);
}

void BehindPlane::take_rays(const DriftingView& view, double limit) {
  nearby_.eye = view.eye;
  nearby_.center = view.center;
  nearby_.drift = view.drift;
  if (ray_at_.empty()) return;
  const double worst = limit * view.pixel();
  const auto rows = static_cast<std::size_t>(size_.y);
  std::vector<glm::ivec2> ends(rows, glm::ivec2(size_.x, -1));
  nearby_.nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    const SamplePlace place = place_in(*view_, samples_[i]);
    const Course course = view.course_of(rays_[i], place);
    if (!(course.deviation < worst)) continue;
    const glm::ivec2 at = place.pixel - corner_;
    const std::size_t index = index_of(at.x, at.y, place.sample);
    if (ray_at_[index] != kNone) continue;
    ray_at_[index] = static_cast<std::uint32_t>(i);
    places_[i] = static_cast<std::uint32_t>(index);
    nearby_.nearest = std::min(nearby_.nearest, course.start);
    nearby_.deviation = std::max(nearby_.deviation, course.deviation);
    nearby_.deviation_from_eye = std::max(nearby_.deviation_from_eye, course.deviation_from_eye);
    nearby_.beside_eye = std::max(nearby_.beside_eye, course.beside_eye);
    nearby_.drifted = std::max(nearby_.drifted, course.drifted);
    nearby_.radius = std::max(nearby_.radius, course.from_center);
    glm::ivec2& end = ends[static_cast<std::size_t>(at.y)];
    end = {std::min(end.x, at.x), std::max(end.y, at.x)};
  }
  // Samples are located up to rounding and a small fraction of a pixel (`SampleScan`).
  const double loss = 4.0 * direction_rounding(*view_) +
                      1e-5 * (glm::length(view_->right()) + glm::length(view_->down()));
  nearby_.deviation += loss;
  nearby_.beside_eye = std::max(nearby_.beside_eye, nearby_.drifted);
  nearby_.deviation_from_eye += loss;
  std::vector<glm::dvec2> corners;
  const glm::dvec2 pixels(view_->width(), view_->height());
  for (int y = 0; y < size_.y; ++y) {
    const glm::ivec2 end = ends[static_cast<std::size_t>(y)];
    if (end.y < 0) continue;
    for (const int row : {y, y + 1}) {
      for (const int column : {end.x, end.y + 1}) {
        corners.push_back(glm::dvec2(corner_ + glm::ivec2(column, row)) / pixels);
      }
    }
  }
  part_ = cover(corners);
}

/// Takes the plane through three origins that are far apart, moved below all origins. If not all
/// rays rise from it, takes a plane across the view instead.
void BehindPlane::find_plane() {
  const auto farthest = [&](auto distance) {
    dvec3 best(0.0);
    double most = -1.0;
    for_each_taken([&](const Ray& ray) {
      const double at = distance(dvec3(ray.origin));
      if (at > most) best = dvec3(ray.origin);
      most = std::max(most, at);
    });
    return best;
  };
  const dvec3 first = farthest([](const dvec3&) { return 0.0; });
  const dvec3 second = farthest([&](const dvec3& at) { return glm::length(at - first); });
  const dvec3 third = farthest(
      [&](const dvec3& at) { return glm::length(glm::cross(second - first, at - first)); });
  normal_ = glm::cross(second - first, third - first);
  normal_ *= (glm::dot(normal_, first - nearby_.eye) < 0.0 ? -1.0 : 1.0) / glm::length(normal_);
  bool all_rise = true;
  for_each_taken([&](const Ray& ray) {
    if (!(glm::dot(normal_, dvec3(ray.direction)) > 0.0)) all_rise = false;
  });
  if (!all_rise) normal_ = view_->forward();
  limit_ = std::numeric_limits<double>::infinity();
  for_each_taken(
      [&](const Ray& ray) { limit_ = std::min(limit_, glm::dot(normal_, dvec3(ray.origin))); });
  // The margin is larger than the distance of a computed hit from its primitive and far smaller
  // than the distance from surfaces at which rays begin.
  limit_ -= 16.0 * overlap_tolerance(*scene_);
}

std::vector<std::uint8_t> BehindPlane::finished() const {
  std::vector<std::uint8_t> finished(ray_at_.size());
  std::ranges::transform(ray_at_, finished.begin(),
                         [](std::uint32_t ray) { return ray == kNone ? 1 : 0; });
  return finished;
}

std::vector<SampleLattice> BehindPlane::lattices(const PrimaryRays& rays, bool) const {
  std::vector<SampleLattice> lattices;
  for (int sample = 0; sample < rays.samples(); ++sample) {
    const glm::dvec2 offset = rays.offsets()[static_cast<std::size_t>(sample)];
    lattices.push_back({offset + glm::dvec2(corner_), size_.x, size_.y, {{0, 0, sample}}});
  }
  return lattices;
}

std::int64_t BehindPlane::handover(const BeamRules& rules) {
  return std::max(rules.handover, kSmallBeam);
}

SampleRay BehindPlane::ray(const SampleScan&, const SampleLattice& lattice, int x, int y) const {
  const Ray& ray = rays_[ray_at_[index_of(x, y, lattice)]];
  return {ray, static_cast<float>(glm::dot(view_->forward(), dvec3(ray.origin) - nearby_.eye)),
          static_cast<float>(glm::dot(view_->forward(), dvec3(ray.direction)))};
}

bool BehindPlane::has(const octree::OctreeCursor& node) const {
  if (node.node().count == 0) return true;
  const Box box = octree_->grid().box(node.corner(), node.size());
  if (highest(normal_, box.lower, box.upper) < limit_) return true;
  if (highest(-normal_, box.lower, box.upper) < -limit_) return false;
  if (node.node().is_leaf()) {
    return std::ranges::all_of(octree_->references(node.node()),
                               [&](scenes::PrimitiveId id) { return is_behind(id); });
  }
  const std::int32_t half = node.size() / 2;
  for (int child = 0; child < 8; ++child) {
    octree::OctreeCursor inside = node;
    inside.enter_child(node.corner() + half * glm::ivec3(child & 1, child >> 1 & 1, child >> 2));
    if (!has(inside)) return false;
  }
  return true;
}

bool BehindPlane::is_behind(scenes::PrimitiveId id) const {
  const scenes::Primitive& primitive = scene_->primitives[id];
  if (primitive.kind != scenes::PrimitiveKind::kPolygon) {
    const scenes::Bounds bounds = scenes::primitive_bounds(*scene_, id);
    return highest(normal_, dvec3(bounds.lower), dvec3(bounds.upper)) < limit_;
  }
  const scenes::Polygon& polygon = scene_->polygons[primitive.index];
  return std::ranges::all_of(
      std::span(scene_->corners).subspan(polygon.first_corner, polygon.corner_count),
      [&](std::uint32_t corner) {
        return glm::dot(normal_, dvec3(scene_->vertices[corner])) < limit_;
      });
}

}  // namespace beambench::accel::beam
