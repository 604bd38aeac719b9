#pragma once
// Predicts the number of references of a structure during its build, so that excessive builds are
// refused early.

#include <cstddef>
#include <cstdint>
#include <functional>

#include <glm/vec3.hpp>

#include "accel/core/cell_grid.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel {

/// Returns a lower bound of how many cells of this size a primitive's surface overlaps, in a grid
/// that contains the primitive. It is the largest of: one; the number that covers its projected
/// area along an axis; the length of its box in cells; and, for a sphere, the number of cells
/// around the cell edges that it crosses.
double least_cells(const scenes::Scene& scene, scenes::PrimitiveId id, const glm::dvec3& cell);

/// Returns a lower bound of the references of all cells of a grid over the whole scene: the sum of
/// `least_cells`. The bound is two thirds of the references for a large sphere, and a third or more
/// for a large triangle.
double least_references(const scenes::Scene& scene, const CellGrid& grid);

/// Limits the references of a structure during its build.
class ReferenceLimit {
 public:
  /// Allows at most `most`.
  explicit ReferenceLimit(std::uint64_t most) : most_(most), next_(most) {}
  /// Allows at most `most`. Once there are many references per primitive, `will_exceed` is called
  /// once to predict whether the limit will be exceeded, so that an excessive build ends early;
  /// scenes of small primitives never pay for the call. It must not return true for a build within
  /// the limit.
  ReferenceLimit(std::uint64_t most, const scenes::Scene& scene, std::function<bool()> will_exceed);
  /// Allows at most `most` in the finest cells of a grid over the whole scene, which will have at
  /// least `least_references`. The scene and the grid must outlive this object.
  ReferenceLimit(std::uint64_t most, const scenes::Scene& scene, const CellGrid& grid);

  /// Returns whether the limit will be exceeded, given that `made` references exist.
  bool exceeded(std::uint64_t made) { return made > next_ && is_too_much(made); }

 private:
  bool is_too_much(std::uint64_t made);

  std::uint64_t most_;
  std::uint64_t next_;  ///< number of references at which to check again
  std::function<bool()> will_exceed_;
};

}  // namespace beambench::accel
