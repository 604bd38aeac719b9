#include "accel/core/tree_quality.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

#include <glm/geometric.hpp>

#include "accel/core/clipped_polygon.hpp"
#include "accel/core/padded_bounds.hpp"

namespace beambench::accel {
namespace {

constexpr double kBoxTest = 0.6;
constexpr double kPrimitiveTest = 1.0;

double area_of(const scenes::Sphere& sphere) {
  const double radius = sphere.radius;
  return 4.0 * std::numbers::pi * radius * radius;
}

double area_of(const scenes::Cone& cone) {
  const double from = cone.base_radius;
  const double to = cone.apex_radius;
  const double length = glm::length(glm::dvec3(cone.apex) - glm::dvec3(cone.base));
  return std::numbers::pi * (from + to) * std::hypot(length, to - from);
}

double area_of(const scenes::Scene& scene, const scenes::Triangle& triangle) {
  const auto corner = [&](std::size_t i) { return glm::dvec3(scene.vertices[triangle.vertex[i]]); };
  return 0.5 * glm::length(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
}

std::span<const scenes::Triangle> triangles_of(const scenes::Scene& scene,
                                               const scenes::Primitive& primitive) {
  const scenes::Polygon& polygon = scene.polygons[primitive.index];
  return std::span(scene.triangles).subspan(polygon.first_triangle, polygon.triangle_count);
}

double area_of(const scenes::Scene& scene, scenes::PrimitiveId id) {
  const scenes::Primitive& primitive = scene.primitives[id];
  switch (primitive.kind) {
    case scenes::PrimitiveKind::kSphere:
      return area_of(scene.spheres[primitive.index]);
    case scenes::PrimitiveKind::kCone:
      return area_of(scene.cones[primitive.index]);
    case scenes::PrimitiveKind::kPolygon:
      break;
  }
  double area = 0.0;
  for (const scenes::Triangle& triangle : triangles_of(scene, primitive)) {
    area += area_of(scene, triangle);
  }
  return area;
}

/// Calls `put(share, angle)` for evenly distributed points of a surface of revolution: with the
/// share of the surface up to the point, and an angle that advances by the golden angle.
template <class Put>
void for_each_point(const Put& put) {
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  for (std::size_t i = 0; i < TreeQuality::kSolidPoints; ++i) {
    const auto number = static_cast<double>(i);
    put((number + 0.5) / TreeQuality::kSolidPoints, number * golden);
  }
}

std::vector<glm::dvec3> points_of(const scenes::Sphere& sphere) {
  std::vector<glm::dvec3> points;
  for_each_point([&](double share, double angle) {
    const double z = 1.0 - 2.0 * share;
    const double across = std::sqrt(1.0 - z * z);
    const glm::dvec3 direction(across * std::cos(angle), across * std::sin(angle), z);
    points.push_back(glm::dvec3(sphere.center) + static_cast<double>(sphere.radius) * direction);
  });
  return points;
}

/// Returns points of a cone's surface. Its area per unit of height is proportional to the radius.
std::vector<glm::dvec3> points_of(const scenes::Cone& cone) {
  const glm::dvec3 base(cone.base);
  const glm::dvec3 axis = glm::dvec3(cone.apex) - base;
  const glm::dvec3 along = glm::normalize(axis);
  const glm::dvec3 beside = std::abs(along.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(along, beside));
  const glm::dvec3 v = glm::cross(along, u);
  const double from = cone.base_radius;
  const double to = cone.apex_radius;
  std::vector<glm::dvec3> points;
  for_each_point([&](double share, double angle) {
    const double radius = std::sqrt(std::lerp(from * from, to * to, share));
    const double place = from == to ? share : (radius - from) / (to - from);
    points.push_back(base + place * axis + radius * (std::cos(angle) * u + std::sin(angle) * v));
  });
  return points;
}

/// Measures how much of a primitive's surface lies in a box.
class Surface {
 public:
  Surface(const scenes::Scene& scene, scenes::PrimitiveId id)
      : scene_(scene), area_(area_of(scene, id)) {
    const scenes::Primitive& primitive = scene.primitives[id];
    switch (primitive.kind) {
      case scenes::PrimitiveKind::kSphere:
        points_ = points_of(scene.spheres[primitive.index]);
        break;
      case scenes::PrimitiveKind::kCone:
        points_ = points_of(scene.cones[primitive.index]);
        break;
      case scenes::PrimitiveKind::kPolygon:
        triangles_ = triangles_of(scene, primitive);
        break;
    }
  }

  double area() const { return area_; }

  double area_in(const Box& box) const {
    double area = 0.0;
    for (const scenes::Triangle& triangle : triangles_) {
      area += clipped_triangle(scene_, triangle, box).area();
    }
    if (points_.empty()) return area;
    const auto inside = std::ranges::count_if(points_, [&](const glm::dvec3& point) {
      return glm::clamp(point, box.lower, box.upper) == point;
    });
    return area_ * static_cast<double>(inside) / TreeQuality::kSolidPoints;
  }

 private:
  const scenes::Scene& scene_;
  double area_;
  std::span<const scenes::Triangle> triangles_;
  std::vector<glm::dvec3> points_;  ///< of a sphere or a cone
};

bool meets(const scenes::Bounds& a, const scenes::Bounds& b) {
  for (int axis = 0; axis < 3; ++axis) {
    if (a.lower[axis] > b.upper[axis] || b.lower[axis] > a.upper[axis]) return false;
  }
  return true;
}

/// The overlap of one primitive with the nodes of a hierarchy.
class Overlap {
 public:
  /// `places` are the primitive's positions in the list of all leaves' primitives, ascending.
  Overlap(std::span<const TreeQuality::Entry> entries, std::span<const std::size_t> places,
          const Surface& surface, const scenes::Bounds& bounds)
      : entries_(entries), places_(places), surface_(surface), bounds_(bounds) {}

  /// Returns the sum, over all nodes without the primitive below them, of the node's cost times the
  /// primitive's area in its box.
  double weighted_area() const {
    double sum = 0.0;
    for (std::uint32_t node = 0; node < entries_.size();) {
      const TreeQuality::Entry& entry = entries_[node];
      const double area = area_in(entry);
      sum += area * entry.cost();
      node = area > 0.0 || is_below(entry) ? node + 1 : entry.end;
    }
    return sum;
  }

 private:
  bool is_below(const TreeQuality::Entry& entry) const {
    const auto found = std::ranges::lower_bound(places_, entry.first);
    return found != places_.end() && *found < entry.last;
  }

  /// Returns the primitive's area in the box of a node; 0 if the primitive is below the node.
  double area_in(const TreeQuality::Entry& entry) const {
    if (!meets(entry.box, bounds_) || is_below(entry)) return 0.0;
    return surface_.area_in({glm::dvec3(entry.box.lower), glm::dvec3(entry.box.upper)});
  }

  std::span<const TreeQuality::Entry> entries_;
  std::span<const std::size_t> places_;
  const Surface& surface_;
  scenes::Bounds bounds_;
};

/// A primitive that represents `weight` primitives of its area.
struct Sample {
  scenes::PrimitiveId id;
  double weight;
};

std::vector<Sample> samples_of(const scenes::Scene& scene) {
  const auto count = static_cast<scenes::PrimitiveId>(scene.primitives.size());
  std::vector<Sample> samples;
  if (count <= TreeQuality::kMostSamples) {
    for (scenes::PrimitiveId id = 0; id < count; ++id) samples.push_back({id, 1.0});
    return samples;
  }
  std::vector<double> areas(count);
  for (scenes::PrimitiveId id = 0; id < count; ++id) areas[id] = area_of(scene, id);
  const double step = std::reduce(areas.begin(), areas.end()) / TreeQuality::kMostSamples;
  double next = 0.5 * step;
  double sum = 0.0;
  for (scenes::PrimitiveId id = 0; id < count; ++id) {
    sum += areas[id];
    if (next >= sum) continue;
    const double steps = std::ceil((sum - next) / step);
    next += steps * step;
    samples.push_back({id, steps * step / areas[id]});
  }
  return samples;
}

}  // namespace

double TreeQuality::Entry::cost() const {
  return children > 0 ? kBoxTest * children : kPrimitiveTest * static_cast<double>(last - first);
}

void TreeQuality::open(const scenes::Bounds& box) {
  if (!open_.empty()) ++entries_[open_.back()].children;
  open_.push_back(static_cast<std::uint32_t>(entries_.size()));
  entries_.push_back({.box = box, .first = primitives_.size()});
}

void TreeQuality::close() {
  Entry& entry = entries_[open_.back()];
  entry.end = static_cast<std::uint32_t>(entries_.size());
  entry.last = primitives_.size();
  open_.pop_back();
}

double TreeQuality::sah_cost() const {
  double cost = 0.0;
  for (const Entry& entry : entries_) cost += half_area(entry.box) * entry.cost();
  return cost / half_area(entries_.front().box);
}

double TreeQuality::epo(const scenes::Scene& scene) const {
  // The positions of each primitive: those of id are [ends[id], ends[id + 1]).
  std::vector<std::size_t> ends(scene.primitives.size() + 1, 0);
  for (const scenes::PrimitiveId id : primitives_) ++ends[id + 1];
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  std::vector<std::size_t> next(ends.begin(), ends.end() - 1);
  std::vector<std::size_t> places(primitives_.size());
  for (std::size_t i = 0; i < primitives_.size(); ++i) places[next[primitives_[i]]++] = i;
  double overlap = 0.0;
  double whole = 0.0;
  for (const Sample& sample : samples_of(scene)) {
    const auto own =
        std::span(places).subspan(ends[sample.id], ends[sample.id + 1] - ends[sample.id]);
    const Surface surface(scene, sample.id);
    const Overlap of_primitive(entries_, own, surface, scenes::primitive_bounds(scene, sample.id));
    overlap += sample.weight * of_primitive.weighted_area();
    whole += sample.weight * surface.area();
  }
  return whole > 0.0 ? overlap / whole : 0.0;
}

void append_quality(const Accelerator& structure, const scenes::Scene& scene,
                    Statistics& statistics) {
  const auto* hierarchy = dynamic_cast<const BoxHierarchy*>(&structure);
  if (hierarchy == nullptr) return;
  TreeQuality tree;
  hierarchy->describe(tree);
  if (tree.empty()) return;
  statistics.more.emplace_back("sah_cost", tree.sah_cost());
  statistics.more.emplace_back("epo", tree.epo(scene));
}

}  // namespace beambench::accel
