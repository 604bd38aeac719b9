#include "harness/thesis/cluster/split/scene_division.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numeric>
#include <utility>

#include "harness/base/messages.hpp"

namespace beambench::cluster {
namespace {

using Owners = std::vector<std::uint16_t>;

constexpr std::array<std::string_view, 5> kNames{"primitives", "cost", "interleaved", "bisection",
                                                 "scattered"};

std::uint32_t morton(const glm::ivec3& cell) {
  std::uint32_t code = 0;
  for (unsigned bit = 0; bit < 7; ++bit) {
    for (unsigned axis = 0; axis < 3; ++axis) {
      const auto coordinate = static_cast<std::uint32_t>(cell[static_cast<int>(axis)]);
      code |= (coordinate >> bit & 1U) << (3 * bit + axis);
    }
  }
  return code;
}

std::vector<std::uint32_t> in_morton_order(const LevelCells& cells) {
  std::vector<std::uint32_t> order(cells.count());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, {}, [&](std::uint32_t i) { return morton(cells.cell(i)); });
  return order;
}

/// Returns consecutive runs with about the same weight.
Owners runs(std::span<const std::uint32_t> order, std::span<const double> weights, int processes) {
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  Owners owners(order.size());
  double before = 0.0;
  for (const std::uint32_t i : order) {
    const double middle = (before + 0.5 * weights[i]) / total;
    owners[i] = static_cast<std::uint16_t>(
        std::min(processes - 1, static_cast<int>(middle * static_cast<double>(processes))));
    before += weights[i];
  }
  return owners;
}

/// Deals the cells out in turn. Empty cells are dealt out separately; they need owners because
/// beams may begin in them.
Owners interleaved(std::span<const std::uint32_t> order, const CellLoads& loads, int processes) {
  Owners owners(order.size());
  std::array<int, 2> dealt{};
  for (const std::uint32_t i : order) {
    int& number = dealt[loads.primitives[i] > 0 ? 1 : 0];
    owners[i] = static_cast<std::uint16_t>(number++ % processes);
  }
  return owners;
}

/// A box of cells, and the processes that share it.
struct Part {
  glm::ivec3 lower;
  glm::ivec3 upper;  ///< exclusive
  int first;
  int processes;
};

class Bisection {
 public:
  Bisection(const LevelCells& cells, std::span<const double> weights)
      : cells_(&cells), weights_(weights), owners_(cells.count()) {}

  Owners operator()(int processes) && {
    halve({glm::ivec3(0), glm::ivec3(cells_->along()), 0, processes});
    return std::move(owners_);
  }

 private:
  template <class Visit>
  void for_each_cell(const Part& part, Visit visit) const {
    for (int z = part.lower.z; z < part.upper.z; ++z) {
      for (int y = part.lower.y; y < part.upper.y; ++y) {
        for (int x = part.lower.x; x < part.upper.x; ++x) {
          const glm::ivec3 cell(x, y, z);
          visit(cell, cells_->index(cell));
        }
      }
    }
  }

  struct Plane {
    int axis;
    int at;
    double error;  ///< relative difference between the lower side and its share
  };

  /// Returns the plane for which the load of the lower side is closest to its processes' share.
  /// There must be more than one layer.
  Plane best_plane(const Part& part, int axis, double share) const {
    std::vector<double> layers(static_cast<std::size_t>(part.upper[axis] - part.lower[axis]));
    for_each_cell(part, [&](const glm::ivec3& cell, std::uint32_t i) {
      layers[static_cast<std::size_t>(cell[axis] - part.lower[axis])] += weights_[i];
    });
    const double total = std::accumulate(layers.begin(), layers.end(), 0.0);
    Plane best{axis, part.lower[axis] + 1, 2.0};
    double below = 0.0;
    for (std::size_t layer = 0; layer + 1 < layers.size(); ++layer) {
      below += layers[layer];
      const double error = std::abs(below / total - share);
      if (error < best.error) {
        best = {axis, part.lower[axis] + static_cast<int>(layer) + 1, error};
      }
    }
    return best;
  }

  void halve(const Part& part) {
    const glm::ivec3 size = part.upper - part.lower;
    if (part.processes == 1 || (size.x == 1 && size.y == 1 && size.z == 1)) {
      for_each_cell(part, [&](const glm::ivec3&, std::uint32_t i) {
        owners_[i] = static_cast<std::uint16_t>(part.first);
      });
      return;
    }
    const int below = part.processes / 2;
    const double share = static_cast<double>(below) / part.processes;
    Plane plane{0, 0, 3.0};
    for (int axis = 0; axis < 3; ++axis) {
      if (size[axis] == 1) continue;
      if (const Plane found = best_plane(part, axis, share); found.error < plane.error) {
        plane = found;
      }
    }
    Part lower = part;
    Part upper = part;
    lower.upper[plane.axis] = upper.lower[plane.axis] = plane.at;
    lower.processes = below;
    upper.first = part.first + below;
    upper.processes = part.processes - below;
    halve(lower);
    halve(upper);
  }

  const LevelCells* cells_;
  std::span<const double> weights_;
  Owners owners_;
};

/// Assigns the costliest cell first, each to the process with the least cost so far (Graham,
/// "Bounds on multiprocessing timing anomalies", SIAM Journal on Applied Mathematics 17(2), 1969),
/// among those that have room for its primitives.
Owners scattered(std::span<const std::uint32_t> order, std::span<const double> weights,
                 const CellLoads& loads, int processes) {
  std::vector<std::uint32_t> costliest(order.begin(), order.end());
  std::ranges::stable_sort(costliest, std::greater<>(),
                           [&](std::uint32_t i) { return weights[i]; });
  struct Filled {
    double cost = 0.0;
    double primitives = 0.0;
  };
  std::vector<Filled> parts(static_cast<std::size_t>(processes));
  constexpr double kMoreThanTheMean = 1.05;
  const double room = kMoreThanTheMean / processes *
                      std::accumulate(loads.primitives.begin(), loads.primitives.end(), 0.0);
  Owners owners(order.size());
  for (const std::uint32_t i : costliest) {
    const double primitives = loads.primitives[i];
    const auto key = [&](const Filled& part) {
      const bool full = primitives > 0.0 && part.primitives + primitives > room;
      return std::pair(full, full ? part.primitives : part.cost);
    };
    const auto best = std::ranges::min_element(parts, {}, key);
    best->cost += weights[i];
    best->primitives += primitives;
    owners[i] = static_cast<std::uint16_t>(best - parts.begin());
  }
  return owners;
}

/// Returns weights that include a small amount for each cell, so that empty cells are distributed,
/// too.
std::vector<double> weights_of(const CellLoads& loads, SceneDivision division) {
  std::vector<double> weights(loads.primitives.begin(), loads.primitives.end());
  if (needs_costs(division)) weights = loads.costs;
  const double total = std::accumulate(weights.begin(), weights.end(), 1e-9);
  const double little = division == SceneDivision::kPrimitives
                            ? 0.01
                            : 1e-3 * total / static_cast<double>(weights.size());
  for (double& weight : weights) weight += little;
  return weights;
}

}  // namespace

std::span<const std::string_view> division_names() { return kNames; }

SceneDivision parse_scene_division(std::string_view name) {
  return static_cast<SceneDivision>(base::place_of_name("division", name, kNames));
}

bool needs_costs(SceneDivision division) {
  return division == SceneDivision::kCost || division == SceneDivision::kBisection ||
         division == SceneDivision::kScattered;
}

std::vector<std::uint16_t> divide(const LevelCells& cells, const CellLoads& loads,
                                  SceneDivision division, int processes) {
  const std::vector<std::uint32_t> order = in_morton_order(cells);
  const std::vector<double> weights = weights_of(loads, division);
  switch (division) {
    case SceneDivision::kInterleaved:
      return interleaved(order, loads, processes);
    case SceneDivision::kBisection:
      return Bisection(cells, weights)(processes);
    case SceneDivision::kScattered:
      return scattered(order, weights, loads, processes);
    case SceneDivision::kPrimitives:
    case SceneDivision::kCost:
      break;
  }
  return runs(order, weights, processes);
}

}  // namespace beambench::cluster
