#pragma once
// How the cells of a divided scene are distributed among processes.

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

namespace beambench::cluster {

/// The ways that the thesis lists (section 2.3.2.2): the space is divided beforehand, so that each
/// process has as many primitives, or as much work by a sample of the rays; or small cells that are
/// not neighbors are dealt to a process, as pixels are interlaced.
enum class SceneDivision {
  kPrimitives,   ///< runs of cells in Morton order with equal numbers of primitives
  kCost,         ///< runs of cells in Morton order with equal costs
  kInterleaved,  ///< of the cells with primitives, in Morton order, each process has every n-th
  kBisection,    ///< boxes of cells, halved by planes that halve their cost
  kScattered     ///< single cells, the costliest first, each to the process with the least cost
                 ///< that has room: 5% more than its share of primitives
};

/// The names after --division, in the order of `SceneDivision`.
std::span<const std::string_view> division_names();
/// Throws InputError listing the valid names.
SceneDivision parse_scene_division(std::string_view name);

/// Does it need the costs of cells?
bool needs_costs(SceneDivision division);

/// The cells of one level of an octree, numbered with x fastest.
class LevelCells {
 public:
  /// The root being level 1.
  explicit LevelCells(int level) : level_(level), along_(1 << (level - 1)) {}

  int level() const { return level_; }
  /// Along each axis.
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

/// What is in each cell, by its number.
struct CellLoads {
  std::vector<std::uint32_t> primitives;  ///< that reach into it
  std::vector<double> costs;              ///< of any unit; empty where no division needs them
};

/// The owner of each cell, by its number. The same loads give the same owners.
std::vector<std::uint16_t> divide(const LevelCells& cells, const CellLoads& loads,
                                  SceneDivision division, int processes);

}  // namespace beambench::cluster
