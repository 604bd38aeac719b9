#include "harness/thesis/cluster/split/cell_costs.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "accel/core/cell_search.hpp"
#include "accel/core/intersect.hpp"
#include "accel/core/work_counters.hpp"
#include "accel/octree/leaf_walk.hpp"
#include "accel/octree/octree_cursor.hpp"
#include "accel/octree/samet.hpp"

namespace beambench::cluster {
namespace {

using accel::octree::Octree;
using accel::octree::OctreeNode;

/// The number of sample rays along each side of a square image; for other images, the total number
/// is the same.
constexpr double kAlong = 128.0;

/// Costs in nanoseconds, rounded; fitted to the CPU times of 1,170 processes (five scenes in 16, 37
/// and 64 interleaved parts, cells of levels 4 and 5).
constexpr double kBeamsAtLeaf = 40000.0;  ///< for a leaf that a sampled ray passes within a beam
constexpr double kFirstLeaf = 50.0;       ///< for a sample that becomes a ray at an occupied leaf
constexpr double kNextCell = 90.0;        ///< for a ray passed on to another process
constexpr double kNextLeaf = 20.0;        ///< for a ray
constexpr double kTest = 10.0;            ///< for a ray and a primitive

/// Adds up the costs of the sample's rays.
class CellCosts {
 public:
  CellCosts(const scenes::Scene& scene, const Octree& octree, const SceneCells& contents,
            double rays_for_each)
      : scene_(&scene),
        octree_(&octree),
        neighbors_(octree),
        cell_of_(cells_of_nodes(octree, contents)),
        seen_(octree.nodes().size(), false),
        rays_for_each_(rays_for_each),
        costs_(contents.cells().count(), 0.0) {}

  void add(const accel::Ray& ray) {
    accel::ClosestHit closest(ray);
    accel::NoCounting none;
    bool in_beam = true;
    std::uint32_t last = kNone;
    accel::octree::walk_leaves(
        *octree_, neighbors_, ray, none, [&](const OctreeNode& leaf, double exit_t) {
          const auto node = static_cast<std::size_t>(&leaf - octree_->nodes().data());
          const std::uint32_t cell = cell_of_[node];
          if (cell == kNone) return false;
          if (in_beam && !seen_[node]) {
            seen_[node] = true;
            costs_[cell] += kBeamsAtLeaf;
          }
          if (in_beam && leaf.count > 0) {
            costs_[cell] += rays_for_each_ * kFirstLeaf;
            in_beam = false;
          } else if (!in_beam) {
            const double entered = cell == last ? 0.0 : kNextCell;
            costs_[cell] += rays_for_each_ * (entered + kNextLeaf + kTest * leaf.count);
          }
          last = cell;
          return accel::test_references(*scene_, octree_->references(leaf), exit_t, none, closest);
        });
  }

  std::vector<double> take() && { return std::move(costs_); }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  /// Returns the cell of each node. Nodes above the cells and nodes in undivided empty cells have
  /// no cell.
  static std::vector<std::uint32_t> cells_of_nodes(const Octree& octree,
                                                   const SceneCells& contents) {
    const LevelCells& cells = contents.cells();
    const std::int32_t finest = octree.grid().cells.x / cells.along();
    std::vector<std::uint32_t> cell_of(octree.nodes().size(), kNone);
    for (std::uint32_t cell = 0; cell < cells.count(); ++cell) {
      if (contents.is_empty(cell)) continue;
      cell_of[cursor_of(octree, cells.cell(cell) * finest, finest).index()] = cell;
    }
    // Children come after their parent.
    for (std::size_t node = 1; node < cell_of.size(); ++node) {
      if (cell_of[node] == kNone) cell_of[node] = cell_of[octree.nodes()[node].parent];
    }
    return cell_of;
  }

  const scenes::Scene* scene_;
  const Octree* octree_;
  accel::octree::AncestorNeighbors neighbors_;
  std::vector<std::uint32_t> cell_of_;
  std::vector<bool> seen_;  ///< by node: whether it was passed within a beam
  double rays_for_each_;    ///< number of rays of the image per sampled ray
  std::vector<double> costs_;
};

}  // namespace

std::vector<double> sampled_costs(const scenes::Scene& scene,
                                  const accel::octree::OctreeOptions& options,
                                  const accel::PrimaryRays& rays, const SceneCells& contents) {
  const accel::octree::OctreePart all{
      contents.cells().level(), [](const glm::ivec3&) { return true; },
      [&](const glm::ivec3& first, std::int32_t size) { return !contents.is_empty(first, size); }};
  const Octree octree(scene, options, all);
  const double pixels = static_cast<double>(rays.width()) * static_cast<double>(rays.height());
  const double step = std::max(1.0, std::sqrt(pixels) / kAlong);
  CellCosts costs(scene, octree, contents, step * step * rays.samples());
  for (int j = 0; (j + 0.5) * step < rays.height(); ++j) {
    for (int i = 0; (i + 0.5) * step < rays.width(); ++i) {
      costs.add(rays.ray_at((i + 0.5) * step, (j + 0.5) * step));
    }
  }
  return std::move(costs).take();
}

}  // namespace beambench::cluster
