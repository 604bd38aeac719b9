#include "harness/explain/shown_cells.hpp"

#include <cstdint>

#include "accel/core/inspector_of.hpp"
#include "accel/core/tree_quality.hpp"

namespace beambench::explain {
namespace {

std::vector<accel::Cell> nodes_of(const accel::BoxHierarchy& hierarchy) {
  accel::TreeQuality tree;
  hierarchy.describe(tree);
  std::vector<accel::Cell> nodes;
  std::vector<std::uint32_t> ends;  // ends of the nodes that contain the current node
  for (const accel::TreeQuality::Entry& entry : tree.entries()) {
    while (!ends.empty() && ends.back() <= nodes.size()) ends.pop_back();
    ends.push_back(entry.end);
    nodes.push_back({{glm::dvec3(entry.box.lower), glm::dvec3(entry.box.upper)},
                     static_cast<int>(ends.size())});
  }
  return nodes;
}

ShownCells all_cells(const accel::Accelerator& structure, std::span<const accel::Cell> visited) {
  ShownCells shown{"occupied leaves", accel::inspector_of(structure).occupied_cells()};
  if (!shown.cells.empty()) return shown;
  const auto* hierarchy = dynamic_cast<const accel::BoxHierarchy*>(&structure);
  if (hierarchy != nullptr) shown = {"nodes", nodes_of(*hierarchy)};
  if (!shown.cells.empty()) return shown;
  return {"places entered by the rays of the image", {visited.begin(), visited.end()}};
}

}  // namespace

ShownCells shown_cells(const accel::Accelerator& structure, std::span<const accel::Cell> visited,
                       std::size_t most) {
  ShownCells shown = all_cells(structure, visited);
  shown.of = shown.cells.size();
  if (shown.of <= most) return shown;
  std::vector<accel::Cell> kept;
  for (std::size_t i = 0; i < most; ++i) kept.push_back(shown.cells[i * shown.of / most]);
  shown.cells = std::move(kept);
  return shown;
}

}  // namespace beambench::explain
