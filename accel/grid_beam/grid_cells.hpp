#pragma once
// The voxels of a hierarchy of grids, as cells that beams pass through.

#include <cstdint>
#include <optional>
#include <span>

#include "accel/beam/beam.hpp"
#include "accel/beam/beam_paths.hpp"
#include "accel/core/cell_search.hpp"
#include "accel/grid/mailboxes.hpp"
#include "accel/grid_beam/grid_lattice.hpp"
#include "accel/hierarchical_grid/grid_walk.hpp"
#include "accel/hierarchical_grid/hierarchical_grid.hpp"

namespace beambench::accel::grid_beam {

/// The counterpart of `beam::OctreeCells`: a beam's cell is an undivided voxel, and its node is the
/// index of that voxel.
class GridCells {
 public:
  using Tracer = hierarchical_grid::HierarchicalGrid<grid::Mailboxes>;

  /// Both arguments must outlive this object.
  GridCells(const Tracer& tracer, const GridLattice& lattice)
      : tracer_(&tracer), lattice_(&lattice) {}

  /// Returns the grid whose planes contain the faces of all voxels.
  const CellGrid& grid() const { return lattice_->cells(); }
  /// Pushes the first beams (thesis, section 3.4). An eye outside the top grid gets one beam for
  /// each visible face, divided among the voxels behind the face. An eye inside gets one beam, in
  /// the voxel that contains it.
  void begin(const beam::EyeView& view, const beam::ImagePolygon& part,
             beam::BeamQueue& queue) const;
  /// Pushes the parts of a beam behind its voxel: divided among the faces through which its rays
  /// leave, then among the voxels behind each face.
  void advance(const beam::EyeView& view, const beam::Beam& beam, beam::BeamQueue& queue) const;
  /// Returns the references of the beam's voxel.
  std::span<const scenes::PrimitiveId> references(const beam::Beam& beam) const {
    return hierarchy().references(hierarchy().voxel(beam.node));
  }

  /// Traces a ray behind the beam's voxel, which it leaves at t.
  template <class Counting, class Watch>
  void follow(const scenes::Scene& scene, const beam::Beam&, const Ray& ray, const CellRay&,
              double t, ClosestHit& closest, Counting& counting, const Watch&) const {
    grid::Mailboxes boxes(scene.primitives.size());
    hierarchical_grid::GridWalk(
        hierarchy(), ray, counting,
        [&](std::span<const scenes::PrimitiveId> references, double exit_t) {
          return test_references(scene, references, exit_t, counting, closest, boxes);
        })
        .from(t);
  }

  /// Traces a ray from its origin.
  template <class Counting>
  std::optional<Hit> find_closest(const Ray& ray, Counting& counting) const {
    return tracer_->find_closest(ray, counting);
  }

 private:
  const hierarchical_grid::GridHierarchy& hierarchy() const { return tracer_->hierarchy(); }

  const Tracer* tracer_;
  const GridLattice* lattice_;
};

}  // namespace beambench::accel::grid_beam
