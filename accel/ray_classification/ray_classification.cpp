#include "accel/ray_classification/ray_classification.hpp"

#include <algorithm>

#include <glm/common.hpp>

#include "accel/core/padded_bounds.hpp"
#include "accel/core/tolerance.hpp"

namespace beambench::accel::ray_classification {
namespace {

/// Returns the box of a set's origins in scene coordinates.
Box origins_of(const Face& face, const Hypercube& rays) {
  Box box{};
  const auto along = static_cast<int>(face.along);
  box.lower[along] = face.sign > 0.0 ? rays[0].low : -rays[0].high;
  box.upper[along] = face.sign > 0.0 ? rays[0].high : -rays[0].low;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto aside = static_cast<int>(face.aside[i]);
    box.lower[aside] = rays[1 + i].low;
    box.upper[aside] = rays[1 + i].high;
  }
  return box;
}

Box widened(const scenes::Bounds& bounds, double by) {
  return {glm::dvec3(bounds.lower) - by, glm::dvec3(bounds.upper) + by};
}

}  // namespace

std::vector<ParameterInfo> RayClassification::parameters() {
  const RayTreeOptions defaults;
  return {integer_parameter("max_candidates", static_cast<std::int64_t>(defaults.max_candidates), 1,
                            1'000'000, "a set of rays that may meet more primitives is divided"),
          integer_parameter("max_depth", defaults.max_depth, 0, 60,
                            "maximum number of divisions of a set"),
          integer_parameter("max_references", static_cast<std::int64_t>(defaults.max_references), 1,
                            2'000'000'000,
                            "approximate number of list entries (4 bytes each) beyond which no "
                            "more sets are divided; the hits are the same")};
}

RayTreeOptions RayClassification::options_from(const Parameters& parameters) {
  RayTreeOptions options;
  options.max_candidates = static_cast<std::size_t>(parameters.integer("max_candidates"));
  options.max_depth = static_cast<int>(parameters.integer("max_depth"));
  options.max_references = static_cast<std::uint64_t>(parameters.integer("max_references"));
  return options;
}

RayClassification::RayClassification(const scenes::Scene& scene, const RayTreeOptions& options)
    : scene_(&scene),
      boxes_(padded_primitive_bounds(scene)),
      references_(std::make_unique<std::atomic<std::uint64_t>>(0)) {
  // Boxes are widened again, for the rounding of a ray's origin and slopes and of `may_meet`.
  const double tolerance = overlap_tolerance(scene);
  std::vector<Box> classified;
  classified.reserve(boxes_.size());
  for (const scenes::Bounds& box : boxes_) {
    bounds_.include(box);
    classified.push_back(widened(box, tolerance));
  }
  if (boxes_.empty()) return;
  for (std::size_t face = 0; face < kFaces; ++face) {
    trees_[face] = std::make_unique<RayTree>(face, widened(bounds_, tolerance), classified, options,
                                             *references_);
  }
}

Point RayClassification::point_of(const CanonicalRay& ray, const Face& face) const {
  // Finds the point where the ray enters the box in double, because a float t may lie behind a hit
  // at that point. A hit slightly before t_min may round to t_min.
  double t = ray.t_min * (1.0 - 0x1p-23);
  for (int axis = 0; axis < 3; ++axis) {
    if (ray.direction[axis] == 0.0) continue;
    const float near = ray.direction[axis] > 0.0 ? bounds_.lower[axis] : bounds_.upper[axis];
    t = std::max(t, (near - ray.origin[axis]) / ray.direction[axis]);
  }
  const glm::dvec3 place =
      glm::clamp(ray.at(t), glm::dvec3(bounds_.lower), glm::dvec3(bounds_.upper));
  const auto along = static_cast<int>(face.along);
  const double length = face.sign * ray.direction[along];
  Point point{};
  point[0] = face.sign * place[along];
  for (std::size_t i = 0; i < 2; ++i) {
    const auto aside = static_cast<int>(face.aside[i]);
    point[1 + i] = place[aside];
    point[3 + i] = ray.direction[aside] / length;
  }
  return point;
}

TraceStep RayClassification::step_of(const RayTree& tree, const RayTree::Place& place, bool is_leaf,
                                     const BoxInterval& inside) {
  TraceStep step;
  step.place = is_leaf ? "leaf" : "node";
  step.index = place.code;
  step.level = place.depth + 1;
  step.box = origins_of(tree.face(), place.rays);
  step.t_enter = inside.enter;
  step.t_exit = inside.exit;
  return step;
}

Statistics RayClassification::statistics() const {
  Statistics statistics;
  statistics.bytes = sizeof(*this) + boxes_.capacity() * sizeof(scenes::Bounds);
  for (const auto& tree : trees_) {
    if (tree) tree->describe(statistics);
  }
  return statistics;
}

std::vector<Cell> RayClassification::occupied_cells() const {
  std::vector<Cell> cells;
  for (const auto& tree : trees_) {
    if (!tree) continue;
    tree->for_each_leaf([&](const RayTree::Place& place) {
      if (place.set->candidates.empty()) return;
      cells.push_back({origins_of(tree->face(), place.rays), place.depth + 1});
    });
  }
  return cells;
}

void register_ray_classification(Registry& registry) {
  registry.add({"ray-classification",
                "divides the set of rays in five dimensions as rays arrive; each set lists the "
                "primitives that its rays may meet, nearest first (Arvo and Kirk 1987)",
                Conformance::kBitExact, RayClassification::parameters(),
                [](const scenes::Scene& scene, const Parameters& parameters, const Workload&) {
                  return std::make_unique<RayClassification>(
                      scene, RayClassification::options_from(parameters));
                }});
}

}  // namespace beambench::accel::ray_classification
