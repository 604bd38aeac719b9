#pragma once
// References predicted while they are made, so that too many are refused early.

#include <cstddef>
#include <cstdint>
#include <functional>

#include <glm/vec3.hpp>

#include "accel/core/cell_grid.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel {

/// A lower bound of how many cells of that size, of a grid that holds the primitive, its surface
/// reaches into: at least one, at least as many as cover the area that it projects to along an
/// axis, as many as its box is long, and of a sphere, as many as lie around the edges of cells that
/// it crosses.
double least_cells(const scenes::Scene& scene, scenes::PrimitiveId id, const glm::dvec3& cell);

/// A lower bound of the references of all cells of a grid over the whole scene: the sum of
/// `least_cells`. Of a large sphere it is two thirds of them, of a large triangle a third or more.
double least_references(const scenes::Scene& scene, const CellGrid& grid);

/// Watches the references of a structure while they are made.
class ReferenceLimit {
 public:
  /// No more than `most`.
  explicit ReferenceLimit(std::uint64_t most) : most_(most), next_(most) {}
  /// No more than `most`. As soon as there are many references for each primitive, `will_exceed` is
  /// asked once whether there will be more, so that what is too much ends there; scenes of small
  /// primitives never pay for it. It must not say so of what fits.
  ReferenceLimit(std::uint64_t most, const scenes::Scene& scene, std::function<bool()> will_exceed);
  /// No more than `most`, of all finest cells of a grid over the whole scene: `least_references` of
  /// them are certain. Scene and grid outlive it.
  ReferenceLimit(std::uint64_t most, const scenes::Scene& scene, const CellGrid& grid);

  /// Will there be more than the limit, now that so many have been made?
  bool exceeded(std::uint64_t made) { return made > next_ && is_too_much(made); }

 private:
  bool is_too_much(std::uint64_t made);

  std::uint64_t most_;
  std::uint64_t next_;  ///< beyond which the next question is decided
  std::function<bool()> will_exceed_;
};

}  // namespace beambench::accel
