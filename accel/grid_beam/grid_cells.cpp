#include "accel/grid_beam/grid_cells.hpp"

#include <algorithm>
#include <cstddef>

#include "accel/beam/beam_division.hpp"
#include "accel/grid/voxel_walk.hpp"

namespace beambench::accel::grid_beam {
namespace {

using beam::Beam;
using beam::BeamQueue;
using beam::Crossing;
using beam::EyeView;
using hierarchical_grid::GridHierarchy;
using hierarchical_grid::NestedGrid;
using hierarchical_grid::Voxel;

void push_at(BeamKind kind, std::uint32_t node, const glm::ivec3& corner, std::int32_t size,
             Beam beam, BeamQueue& queue) {
  beam.node = node;
  beam.corner = corner;
  beam.size = size;
  queue.waiting.push(kind, beam);
  ++queue.appended;
}

BeamKind kind_of(Voxel voxel) {
  return voxel.is_empty() ? BeamKind::kNonTerminal : BeamKind::kOccupied;
}

/// A one-layer block of a grid's voxels behind a face.
struct Layer {
  std::uint32_t grid;
  glm::ivec3 first;
  glm::ivec3 count;
};

/// Divides a beam among the undivided voxels behind a face crossed by all its rays.
class Entry {
 public:
  Entry(const GridHierarchy& hierarchy, const GridLattice& lattice, const EyeView& view,
        const Crossing& face, BeamQueue& queue)
      : hierarchy_(&hierarchy), lattice_(&lattice), view_(&view), face_(face), queue_(&queue) {}

  /// Halves the layer across its longer side until single voxels are left; a divided voxel is
  /// replaced by its own layer.
  void divide(const Layer& layer, const Beam& beam) const {
    if (beam.outline.empty()) return;
    const int u = (face_.axis + 1) % 3;
    const int v = (face_.axis + 2) % 3;
    const int axis = layer.count[u] >= layer.count[v] ? u : v;
    if (layer.count[axis] == 1) {
      enter(layer.grid, layer.first, beam);
      return;
    }
    const GridPlace& place = lattice_->place(layer.grid);
    Layer lower = layer;
    lower.count[axis] /= 2;
    Layer upper = layer;
    upper.first[axis] += lower.count[axis];
    upper.count[axis] -= lower.count[axis];
    const std::int32_t plane = place.corner[axis] + place.size * upper.first[axis];
    halve(*view_, face_, axis, plane, beam, *queue_,
          [&](const Beam& part, bool above) { divide(above ? upper : lower, part); });
  }

  /// Returns the layer of a grid's voxels behind the face, which must be a face of the grid.
  Layer outer_layer(std::uint32_t grid) const {
    Layer layer{grid, glm::ivec3(0), hierarchy_->grids()[grid].place().cells};
    layer.first[face_.axis] = face_.side > 0 ? 0 : layer.count[face_.axis] - 1;
    layer.count[face_.axis] = 1;
    return layer;
  }

  /// Returns the voxels behind the face of a cell, or the single larger voxel behind it, searching
  /// down from the top grid.
  Layer behind(const glm::ivec3& corner, std::int32_t size) const {
    glm::ivec3 at = corner;  // a finest cell behind the face
    at[face_.axis] = face_.side > 0 ? face_.index : face_.index - 1;
    std::uint32_t number = 0;
    while (true) {
      const GridPlace& place = lattice_->place(number);
      Layer layer{number, (at - place.corner) / place.size, glm::ivec3(1)};
      if (place.size < size) {
        layer.count = glm::ivec3(size / place.size);
        layer.count[face_.axis] = 1;
        return layer;
      }
      const NestedGrid& grid = hierarchy_->grids()[number];
      const Voxel voxel =
          hierarchy_->voxel(grid.first_voxel + grid::voxel_index(grid.place(), layer.first));
      if (!voxel.is_divided()) return layer;
      number = voxel.grid();
    }
  }

 private:
  void enter(std::uint32_t number, const glm::ivec3& at, const Beam& beam) const {
    const NestedGrid& grid = hierarchy_->grids()[number];
    const std::size_t node = grid.first_voxel + grid::voxel_index(grid.place(), at);
    const Voxel voxel = hierarchy_->voxel(node);
    if (voxel.is_divided()) {
      divide(outer_layer(voxel.grid()), beam);
      return;
    }
    const GridPlace& place = lattice_->place(number);
    push_at(kind_of(voxel), static_cast<std::uint32_t>(node), place.corner + place.size * at,
            place.size, beam, *queue_);
  }

  const GridHierarchy* hierarchy_;
  const GridLattice* lattice_;
  const EyeView* view_;
  Crossing face_;
  BeamQueue* queue_;
};

/// Pushes a beam in the voxel that contains the eye.
void begin_inside(const GridHierarchy& hierarchy, const GridLattice& lattice, const EyeView& view,
                  const Beam& screen, BeamQueue& queue) {
  std::uint32_t number = 0;
  while (true) {
    const NestedGrid& grid = hierarchy.grids()[number];
    const GridPlace& place = lattice.place(number);
    glm::ivec3 at(0);
    for (int axis = 0; axis < 3; ++axis) {
      // As elsewhere, the planes of the lattice decide.
      while (at[axis] + 1 < grid.place().cells[axis] &&
             lattice.cells().plane(axis, place.corner[axis] + place.size * (at[axis] + 1)) <=
                 view.eye(axis)) {
        ++at[axis];
      }
    }
    const std::size_t node = grid.first_voxel + grid::voxel_index(grid.place(), at);
    const Voxel voxel = hierarchy.voxel(node);
    if (!voxel.is_divided()) {
      push_at(kind_of(voxel), static_cast<std::uint32_t>(node), place.corner + place.size * at,
              place.size, screen, queue);
      return;
    }
    number = voxel.grid();
  }
}

}  // namespace

void GridCells::begin(const EyeView& view, const beam::ImagePolygon& part, BeamQueue& queue) const {
  const std::uint64_t before = queue.appended;
  Beam screen;
  screen.outline = part;
  bool inside = true;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int32_t cells = grid().cells[axis];
    const bool below = view.eye(axis) < grid().plane(axis, 0);
    if (!below && view.eye(axis) <= grid().plane(axis, cells)) continue;
    inside = false;
    const Crossing face{below ? 0 : cells, static_cast<std::int16_t>(axis),
                        static_cast<std::int16_t>(below ? 1 : -1)};
    const Entry entry(hierarchy(), *lattice_, view, face, queue);
    entry.divide(entry.outer_layer(0), part_entering(view, face, screen, queue));
  }
  if (inside) begin_inside(hierarchy(), *lattice_, view, screen, queue);
  queue.made += queue.appended - before;
}

void GridCells::advance(const EyeView& view, const Beam& beam, BeamQueue& queue) const {
  const std::uint64_t before = queue.appended;
  const beam::Exits exits(view, beam);
  for (std::size_t i = 0; i < exits.count(); ++i) {
    const auto cuts = exits.cuts(i);
    queue.clips += cuts.size();
    const Beam part = part_of(beam, {cuts.begin(), cuts.size()});
    if (part.outline.empty()) continue;

    const Crossing& face = exits.face(i);
    ++queue.neighbor_searches;
    if (face.index == 0 || face.index == grid().cells[face.axis]) {
      queue.waiting.push(BeamKind::kLeaving, part);
      ++queue.appended;
    } else {
      const Entry entry(hierarchy(), *lattice_, view, face, queue);
      entry.divide(entry.behind(beam.corner, beam.size), part);
    }
  }
  count_parts(queue.appended - before, queue);
}

}  // namespace beambench::accel::grid_beam
