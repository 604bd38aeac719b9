#pragma once
// The beams of the thesis through a hierarchy of grids.

#include <optional>
#include <vector>

#include "accel/beam/beam_run.hpp"
#include "accel/grid_beam/grid_beam_options.hpp"
#include "accel/grid_beam/grid_cells.hpp"
#include "accel/grid_beam/grid_lattice.hpp"

namespace beambench::accel::grid_beam {

/// Traces primary rays as beams through the voxels of a hierarchy of grids, which the thesis
/// (González López 1999, section 7.3) proposes as future work. In empty voxels the beams continue,
/// divided by the faces and the voxels behind them. At an occupied voxel, the samples of a beam are
/// traced as rays. Samples that leave the top grid become background, and no ray is traced for
/// them. All other rays are traced one by one through the same grids.
class GridBeam : public GridCells::Tracer {
 public:
  GridBeam(const scenes::Scene& scene, const GridBeamOptions& options)
      : GridCells::Tracer(scene, options.grid),
        scene_(&scene),
        rules_(options.rules),
        lattice_(hierarchy()) {}

  /// Traces an image in beams, which are shared among the context's threads.
  void closest_hits(const RaySource& rays, const HitSpan& hits,
                    const QueryContext& context) const override;
  std::optional<std::vector<BeamOutline>> beams(const PrimaryRays& rays) const override;
  /// Samples become rays only at occupied voxels, so some of an image's rays are never generated.
  Statistics statistics() const override;

  const GridLattice& lattice() const { return lattice_; }
  /// Traces an image and reports to a policy (see beam::NoBeamWatch).
  template <class Watch>
  void trace_watched(const PrimaryRays& rays, const HitSpan& buffer, Watch& watch) const {
    const beam::WholeImage sight;
    auto finished = finished_samples(rules_, sight, buffer);
    beam::BeamRun<Watch, beam::WholeImage, GridCells>(*scene_, cells(), rules_, rays, sight, buffer,
                                                      finished, watch)();
  }

 private:
  GridCells cells() const { return {*this, lattice_}; }

  const scenes::Scene* scene_;
  beam::BeamRules rules_;
  GridLattice lattice_;
};

}  // namespace beambench::accel::grid_beam
