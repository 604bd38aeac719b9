// Builds grids in the voxels of grids, from the scene's grid down.

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "accel/core/least_references.hpp"
#include "accel/core/tolerance.hpp"
#include "accel/grid/rasterizer.hpp"
#include "accel/grid/voxel_walk.hpp"
#include "accel/hierarchical_grid/grid_hierarchy.hpp"
#include "scenes/base/error.hpp"

namespace beambench::accel::hierarchical_grid {

namespace {

/// A grid to be made in a voxel.
struct Division {
  std::uint32_t voxel;  ///< index in the surrounding grid
  glm::ivec3 cells;
};

/// Memory used while the voxels of one grid are made. The grids of a level are made one after
/// another, so each level needs only one `Scratch`.
struct Scratch {
  std::vector<grid::VoxelReference> found;
  std::vector<std::uint32_t> first;
  std::vector<scenes::PrimitiveId> references;
  std::vector<Division> divisions;
};

/// The minimum width of a voxel relative to the scene's diagonal: sixteen times the widening of
/// overlaps, so that lists do not depend on the widening.
constexpr double kNarrowest = 0x1p-26;

/// The costs of entering a grid in a voxel, and of each step in it, in ray-primitive tests.
constexpr double kEntryCost = 3.0;
constexpr double kStepCost = 1.0;
/// A grid is made if it is expected to reduce a ray's time to at most this share.
constexpr double kWorthwhile = 0.8;

CellGrid grid_in(const Box& box, const glm::ivec3& cells) {
  return {box.lower, (box.upper - box.lower) / glm::dvec3(cells), cells};
}

}  // namespace

class GridHierarchyBuilder {
 public:
  GridHierarchyBuilder(const scenes::Scene& scene, const HierarchicalGridOptions& options,
                       GridHierarchy& hierarchy)
      : scene_(scene), options_(options), hierarchy_(hierarchy) {
    if (!scene.bounds.empty()) {
      narrowest_ =
          kNarrowest * glm::length(glm::dvec3(scene.bounds.upper) - glm::dvec3(scene.bounds.lower));
    }
  }

  void build() {
    std::vector<scenes::PrimitiveId> all(scene_.primitives.size());
    std::iota(all.begin(), all.end(), scenes::PrimitiveId{0});
    const CellGrid place = grid::make_voxel_grid(scene_, options_);
    if (!rasterize(place, 1, all, {options_.max_references, scene_, place})) fail_too_many();
    voxels_ = grid::voxel_count(place);
    references_ = scratch(1).references.size();
    fill(append(place, 1));
    hierarchy_.grids_.shrink_to_fit();
    hierarchy_.voxels_.shrink_to_fit();
    hierarchy_.references_.shrink_to_fit();
  }

 private:
  Scratch& scratch(int level) { return scratch_[static_cast<std::size_t>(level) - 1]; }

  /// Finds the references of a grid's voxels; returns false if there are more than the limit.
  bool rasterize(const CellGrid& place, int level, std::span<const scenes::PrimitiveId> primitives,
                 ReferenceLimit limit) {
    Scratch& into = scratch(level);
    const grid::Rasterizer rasterizer(scene_, place, options_.assign);
    into.found.clear();
    for (const scenes::PrimitiveId id : primitives) {
      const bool all = rasterizer.for_each_voxel(id, [&](std::size_t voxel) {
        if (limit.exceeded(into.found.size() + 1)) return false;
        into.found.push_back({static_cast<std::uint32_t>(voxel), id});
        return true;
      });
      if (!all) return false;
    }
    grid::sort_by_voxel(into.found, grid::voxel_count(place), into.first, into.references);
    return true;
  }

  /// Makes a grid of empty voxels and returns its number.
  std::uint32_t append(const CellGrid& place, int level) {
    const auto number = static_cast<std::uint32_t>(hierarchy_.grids_.size());
    const std::size_t first = hierarchy_.voxels_.size();
    hierarchy_.grids_.push_back({grid::WalkGrid(place), static_cast<std::uint32_t>(first), level});
    hierarchy_.voxels_.resize(first + grid::voxel_count(place));
    return number;
  }

  /// Fills the voxels of a rasterized grid with references or with grids.
  void fill(std::uint32_t number) {
    const NestedGrid grid = hierarchy_.grids_[number];
    Scratch& own = scratch(grid.level);
    choose_divisions(grid, own);
    auto division = own.divisions.begin();
    const auto count = static_cast<std::uint32_t>(grid::voxel_count(grid.place()));
    for (std::uint32_t voxel = 0; voxel < count; ++voxel) {
      const auto primitives = list(own, voxel);
      Voxel made;
      if (division != own.divisions.end() && division->voxel == voxel) {
        made = divide(grid, *division++, primitives);
      } else {
        made = leaf(primitives);
      }
      hierarchy_.voxels_[grid.first_voxel + voxel] = made;
    }
  }

  Voxel divide(const NestedGrid& grid, const Division& division,
               std::span<const scenes::PrimitiveId> primitives) {
    const Box box = grid.place().box(grid::voxel_at(grid.place(), division.voxel), 1);
    const CellGrid place = grid_in(box, division.cells);
    const int level = grid.level + 1;
    const bool always = options_.divide == HierarchicalGridOptions::Divide::kAlways;
    // The number of references per voxel that keeps all current voxels below the limit.
    const std::uint64_t room = options_.max_references - references_ + primitives.size();
    const std::uint64_t most = always ? room : std::min(room, worthwhile(place, primitives.size()));
    if ((!always && sample_exceeds(place, primitives, most)) ||
        !rasterize(place, level, primitives, ReferenceLimit(most))) {
      if (always) fail_too_many();
      voxels_ -= grid::voxel_count(place);
      return leaf(primitives);
    }
    references_ += scratch(level).references.size() - primitives.size();
    const std::uint32_t inner = append(place, level);
    fill(inner);
    return Voxel::with_grid(inner);
  }

  /// If there are many primitives, returns whether a sample of them shows that they will have more
  /// references than `most`, so that no time is lost on clusters that no grid separates.
  bool sample_exceeds(const CellGrid& place, std::span<const scenes::PrimitiveId> primitives,
                      std::uint64_t most) const {
    constexpr std::size_t kSample = 64;
    const std::size_t stride = primitives.size() / kSample;
    if (stride < 4) return false;
    const grid::Rasterizer rasterizer(scene_, place, options_.assign);
    std::uint64_t left = most / stride * 5 / 4;
    for (std::size_t i = 0; i < primitives.size(); i += stride) {
      if (!rasterizer.for_each_voxel(primitives[i], [&](std::size_t) { return left-- > 0; })) {
        return true;
      }
    }
    return false;
  }

  /// Returns the maximum number of references for which a grid in a voxel of this many primitives
  /// still saves time.
  static std::uint64_t worthwhile(const CellGrid& place, std::size_t primitives) {
    // The expected number of visits to one of the voxels by a ray through the box (MacDonald and
    // Booth, "Heuristics for ray tracing using space subdivision", 1990).
    const double share =
        half_surface(place.cell) / half_surface(place.cell * glm::dvec3(place.cells));
    const double steps = share * static_cast<double>(grid::voxel_count(place));
    const double saved =
        kWorthwhile * static_cast<double>(primitives) - kEntryCost - kStepCost * steps;
    return saved <= 0.0 ? 0 : static_cast<std::uint64_t>(std::min(saved / share, 4e9));
  }

  static double half_surface(const glm::dvec3& size) {
    return size.x * size.y + size.y * size.z + size.z * size.x;
  }

  static std::span<const scenes::PrimitiveId> list(const Scratch& scratch, std::uint32_t voxel) {
    return std::span(scratch.references)
        .subspan(scratch.first[voxel], scratch.first[voxel + 1] - scratch.first[voxel]);
  }

  void choose_divisions(const NestedGrid& grid, Scratch& scratch) {
    scratch.divisions.clear();
    if (grid.level == options_.max_level) return;
    std::uint64_t voxels = voxels_;
    const auto count = static_cast<std::uint32_t>(grid::voxel_count(grid.place()));
    for (std::uint32_t voxel = 0; voxel < count; ++voxel) {
      const std::size_t objects = list(scratch, voxel).size();
      if (objects <= options_.max_objects) continue;
      const glm::ivec3 cells = inner_cells(grid.place().cell, objects);
      const std::uint64_t made = std::uint64_t{1} * static_cast<std::uint32_t>(cells.x) *
                                 static_cast<std::uint32_t>(cells.y) *
                                 static_cast<std::uint32_t>(cells.z);
      if (made == 1) continue;
      voxels += made;
      scratch.divisions.push_back({voxel, cells});
    }
    if (voxels > static_cast<std::uint64_t>(options_.max_voxels)) {
      scratch.divisions.clear();
    } else {
      voxels_ = voxels;
    }
  }

  glm::ivec3 inner_cells(const glm::dvec3& size, std::size_t objects) const {
    const double number = options_.inner_density * static_cast<double>(objects);
    if (options_.inner == HierarchicalGridOptions::Inner::kPowers) return power_cells(size, number);
    const glm::ivec3 wanted =
        grid::cells_by_number(size, number, options_.shape, grid::kMaxCellsPerAxis);
    glm::ivec3 cells(1);
    for (int axis = 0; axis < 3; ++axis) {
      const double most = std::min(size[axis] / narrowest_, double{grid::kMaxCellsPerAxis});
      cells[axis] = std::clamp(wanted[axis], 1, std::max(1, static_cast<int>(most)));
    }
    return cells;
  }

  /// Returns the power of two nearest by ratio to the cube root of `number`. It is limited, so that
  /// finest cells can be numbered.
  glm::ivec3 power_cells(const glm::dvec3& size, double number) const {
    constexpr int kMaxPower = 4;
    int power = std::clamp(static_cast<int>(std::lround(std::log2(number) / 3.0)), 0, kMaxPower);
    const double shortest = std::min({size.x, size.y, size.z});
    while (power > 0 && std::ldexp(shortest, -power) < narrowest_) --power;
    return glm::ivec3(1 << power);
  }

  Voxel leaf(std::span<const scenes::PrimitiveId> primitives) {
    if (primitives.empty()) return {};
    auto& references = hierarchy_.references_;
    const auto first = static_cast<std::uint32_t>(references.size());
    references.push_back(static_cast<scenes::PrimitiveId>(primitives.size()));
    references.insert(references.end(), primitives.begin(), primitives.end());
    return Voxel::with_references(first);
  }

  [[noreturn]] void fail_too_many() const {
    throw InputError(fmt::format(
        "the grids of max_level {} over '{}' ({} primitives) hold more than {} references; lower "
        "density, inner_density or max_level, raise max_objects, or raise max_references (4 bytes "
        "each)",
        options_.max_level, scene_.name, scene_.primitives.size(), options_.max_references));
  }

  const scenes::Scene& scene_;
  const HierarchicalGridOptions& options_;
  GridHierarchy& hierarchy_;
  double narrowest_ = 1.0;
  std::uint64_t voxels_ = 0;      ///< voxels made so far, including those of chosen grids
  std::uint64_t references_ = 0;  ///< total if no further voxel is divided
  std::array<Scratch, kMaxLevels> scratch_;
};

GridHierarchy::GridHierarchy(const scenes::Scene& scene, const HierarchicalGridOptions& options) {
  scene_bounds_ = scene.bounds;
  GridHierarchyBuilder(scene, options, *this).build();
}

}  // namespace beambench::accel::hierarchical_grid
