#pragma once
// Predicts the references of a structure while they are made, so that too many are refused early.

#include <cstddef>
#include <cstdint>
#include <functional>

#include <glm/vec3.hpp>

#include "accel/core/cell_grid.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel {

/// Returns a lower bound of how many cells of that size, of a grid that holds the primitive, its
/// surface overlaps: at least one, at least as many as cover the area that it projects to along an
/// axis, as many as its box is long, and for a sphere, as many as lie around the edges of cells
/// that it crosses.
double least_cells(const scenes::Scene& scene, scenes::PrimitiveId id, const glm::dvec3& cell);

/// Returns a lower bound of the references of all cells of a grid over the whole scene: the sum of
/// `least_cells`. For a large sphere it is two thirds of them, for a large triangle a third or
/// more.
double least_references(const scenes::Scene& scene, const CellGrid& grid);

/// Watches the references of a structure while they are made.
class ReferenceLimit {
 public:
  /// Allows at most `most`.
  explicit ReferenceLimit(std::uint64_t most) : most_(most), next_(most) {}
  /// Allows at most `most`. As soon as there are many references for each primitive, `will_exceed`
  /// is called once to predict whether there will be more, so that an excessive build ends there;
  /// scenes of small primitives never pay for it. It must not return true for a build within the
  /// limit.
  ReferenceLimit(std::uint64_t most, const scenes::Scene& scene, std::function<bool()> will_exceed);
  /// Allows at most `most`, over all finest cells of a grid over the whole scene:
  /// `least_references` of them are certain. Scene and grid outlive it.
  ReferenceLimit(std::uint64_t most, const scenes::Scene& scene, const CellGrid& grid);

  /// Returns whether there will be more than the limit, now that `made` have been made.
  bool exceeded(std::uint64_t made) { return made > next_ && is_too_much(made); }

 private:
  bool is_too_much(std::uint64_t made);

  std::uint64_t most_;
  std::uint64_t next_;  ///< beyond which the next question is decided
  std::function<bool()> will_exceed_;
};

}  // namespace beambench::accel
