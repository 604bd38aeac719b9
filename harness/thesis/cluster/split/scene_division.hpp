#pragma once
// Distributes the cells of a divided scene among processes.

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

namespace beambench::cluster {

/// The methods listed in the thesis (section 2.3.2.2): either space is divided in advance, so that
/// processes have equal numbers of primitives, or equal work as estimated from a sample of the
/// rays; or small nonadjacent cells are dealt out to the processes, like interlaced pixels.
enum class SceneDivision {
  kPrimitives,   ///< runs of cells in Morton order with equal numbers of primitives
  kCost,         ///< runs of cells in Morton order with equal costs
  kInterleaved,  ///< each process has every n-th of the cells with primitives, in Morton order
  kBisection,    ///< boxes of cells, halved by planes that halve their cost
  kScattered     ///< single cells, the costliest first, each to the process with the least cost
};

/// The names after --division, in the order of `SceneDivision`.
std::span<const std::string_view> division_names();
/// Parses the name. Throws InputError listing the valid names.
SceneDivision parse_scene_division(std::string_view name);

/// Returns whether the division needs the costs of cells.
bool needs_costs(SceneDivision division);

/// The cells of one level of an octree, numbered with x fastest.
class LevelCells {
 public:
  /// The root has level 1.
  explicit LevelCells(int level) : level_(level), along_(1 << (level - 1)) {}

  int level() const { return level_; }
  /// Returns the number of cells along each axis.
  std::int32_t along() const { return along_; }
  std::uint32_t count() const { return static_cast<std::uint32_t>(along_ * along_ * along_); }
  std::uint32_t index(const glm::ivec3& cell) const {
    return static_cast<std::uint32_t>((cell.z * along_ + cell.y) * along_ + cell.x);
  }
  glm::ivec3 cell(std::uint32_t index) const {
    const auto i = static_cast<std::int32_t>(index);
    return {i % along_, i / along_ % along_, i / (along_ * along_)};
  }

 private:
  int level_;
  std::int32_t along_;
};

/// The load of each cell, by cell number.
struct CellLoads {
  std::vector<std::uint32_t> primitives;  ///< number of primitives that reach into the cell
  std::vector<double> costs;              ///< in any unit; empty if no division needs them
};

/// Returns the owner of each cell, by cell number. The same loads yield the same owners.
std::vector<std::uint16_t> divide(const LevelCells& cells, const CellLoads& loads,
                                  SceneDivision division, int processes);

}  // namespace beambench::cluster
