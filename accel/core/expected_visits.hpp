#pragma once
// The expected cost of a structure, in the same terms for all structures.

#include <cstddef>

#include <glm/common.hpp>

#include "accel/core/overlap.hpp"
#include "accel/core/statistics.hpp"
#include "scenes/bounds.hpp"

namespace beambench::accel {

/// The surface area heuristic's estimate (Goldsmith and Salmon 1987; MacDonald and Booth 1990): a
/// random line that meets the scene's box meets a convex cell in it with a probability equal to the
/// ratio of their surface areas. The sums over the cells of a structure are the expected numbers of
/// interior nodes and leaves that such a line meets, and of references that it tests, if it never
/// ends at a hit.
class ExpectedVisits {
 public:
  ExpectedVisits() = default;  ///< for an empty scene
  explicit ExpectedVisits(const scenes::Bounds& scene)
      : scene_{glm::dvec3(scene.lower), glm::dvec3(scene.upper)} {}

  void add_node(const Box& cell) { nodes_ += area(cell); }
  /// Adds a leaf; `tests` is its number of references.
  void add_leaf(const Box& cell, std::size_t tests) {
    const double inside = area(cell);
    leaves_ += inside;
    tests_ += inside * static_cast<double>(tests);
  }
  void add_node(const scenes::Bounds& cell) { add_node(boxed(cell)); }
  void add_leaf(const scenes::Bounds& cell, std::size_t tests) { add_leaf(boxed(cell), tests); }

  /// Adds `sah_nodes`, `sah_leaves` and `sah_tests`, unless the scene is empty or its box has no
  /// area.
  void append_to(Statistics& statistics) const {
    const double whole = area(scene_);
    if (!(whole > 0.0)) return;
    statistics.more.emplace_back("sah_nodes", nodes_ / whole);
    statistics.more.emplace_back("sah_leaves", leaves_ / whole);
    statistics.more.emplace_back("sah_tests", tests_ / whole);
  }

 private:
  static Box boxed(const scenes::Bounds& cell) {
    return {glm::dvec3(cell.lower), glm::dvec3(cell.upper)};
  }
  /// Returns half the surface area of the cell's part inside the scene's box; 0 if there is no such
  /// part.
  double area(const Box& cell) const {
    const glm::dvec3 size = glm::min(cell.upper, scene_.upper) - glm::max(cell.lower, scene_.lower);
    if (!(size.x >= 0.0 && size.y >= 0.0 && size.z >= 0.0)) return 0.0;
    return size.x * (size.y + size.z) + size.y * size.z;
  }

  Box scene_{glm::dvec3(0.0), glm::dvec3(0.0)};
  double nodes_ = 0.0;
  double leaves_ = 0.0;
  double tests_ = 0.0;
};

}  // namespace beambench::accel
