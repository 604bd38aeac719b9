#pragma once
// The algorithm: a hierarchy of boxes split at the median of the centers along the longest axis.

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include <beambench/plugin.hpp>

class MedianBvh : public beambench::accel::TraversalAccelerator<MedianBvh> {
 public:
  MedianBvh(const beambench::scenes::Scene& scene, std::uint32_t max_leaf)
      : scene_(&scene),
        boxes_(beambench::accel::padded_primitive_bounds(scene)),
        order_(boxes_.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    if (!order_.empty()) build(0, static_cast<std::uint32_t>(order_.size()), max_leaf, 1);
  }

  /// `counting` receives each piece of work; in timed code its calls are empty
  /// (accel/core/work_counters.hpp).
  template <class Counting>
  std::optional<beambench::accel::Hit> find_closest(const beambench::accel::Ray& ray,
                                                    Counting& counting) const {
    beambench::accel::ClosestHit closest(ray);
    visit(
        ray, counting,
        [&](std::uint32_t id) {
          counting.tested(id, closest.test(*scene_, id));
          return false;
        },
        closest.ray.t_max);
    return closest.result();
  }

  template <class Counting>
  bool find_any(const beambench::accel::Ray& ray, Counting& counting) const {
    const beambench::accel::CanonicalRay canonical(ray);
    return visit(
        ray, counting,
        [&](std::uint32_t id) {
          return beambench::accel::is_hit(beambench::accel::intersect(canonical, *scene_, id));
        },
        canonical.t_max);
  }

  beambench::accel::Statistics statistics() const override {
    beambench::accel::Statistics statistics;
    statistics.nodes = nodes_.size();
    statistics.leaves = (nodes_.size() + 1) / 2;
    statistics.references = order_.size();
    statistics.depth = depth_;
    statistics.bytes = nodes_.capacity() * sizeof(Node) + order_.capacity() * sizeof order_[0];
    return statistics;
  }

 private:
  struct Node {
    beambench::scenes::Bounds box;
    std::uint32_t first;  ///< a leaf's first primitive in order_, or the second child's index
    std::uint32_t count;  ///< 0: an interior node, directly followed by its first child
  };

  void build(std::uint32_t begin, std::uint32_t end, std::uint32_t max_leaf, std::uint64_t level) {
    depth_ = std::max(depth_, level);
    const std::size_t index = nodes_.size();
    nodes_.push_back({{}, begin, end - begin});
    for (std::uint32_t i = begin; i < end; ++i) nodes_[index].box.include(boxes_[order_[i]]);
    if (end - begin <= max_leaf) return;
    const glm::vec3 size = nodes_[index].box.extent();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::uint32_t middle = begin + (end - begin) / 2;
    const auto center = [&](std::uint32_t id) {
      return boxes_[id].lower[axis] + boxes_[id].upper[axis];
    };
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                       return std::pair(center(a), a) < std::pair(center(b), b);
                     });
    nodes_[index].count = 0;
    build(begin, middle, max_leaf, level + 1);
    nodes_[index].first = static_cast<std::uint32_t>(nodes_.size());
    build(middle, end, max_leaf, level + 1);
  }

  /// Visits nodes depth first and ends early when `test` returns true. `t_max` shrinks as hits are
  /// found. A box is skipped only if the ray enters it beyond t_max: at the same t, a primitive
  /// with a lower id may still be found.
  template <class Counting, class Test>
  bool visit(const beambench::accel::Ray& ray, Counting& counting, Test test,
             const float& t_max) const {
    if (nodes_.empty()) return false;
    const beambench::accel::SlabRay slabs(ray);
    std::uint32_t stack[64];  // the median halves the list: 2^32 primitives need 32 levels
    int size = 0;
    stack[size++] = 0;
    while (size > 0) {
      const std::uint32_t index = stack[--size];
      const Node& node = nodes_[index];
      counting.add(beambench::accel::Counter::kBoxTests);
      if (slabs.interval(node.box, ray.t_min, t_max).empty()) continue;
      counting.add(beambench::accel::Counter::kTraversalSteps);
      if (node.count == 0) {
        stack[size++] = node.first;
        stack[size++] = index + 1;
        continue;
      }
      counting.add(beambench::accel::Counter::kLeaves);
      counting.add(beambench::accel::Counter::kPrimitiveTests, node.count);
      for (std::uint32_t i = 0; i < node.count; ++i) {
        if (test(order_[node.first + i])) return true;
      }
    }
    return false;
  }

  const beambench::scenes::Scene* scene_;
  std::vector<beambench::scenes::Bounds> boxes_;  ///< widened for hits beside primitives
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
  std::uint64_t depth_ = 0;
};
