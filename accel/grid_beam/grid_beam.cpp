#include "accel/grid_beam/grid_beam.hpp"

#include <memory>
#include <utility>

#include "accel/beam/beam_counters.hpp"
#include "accel/beam/beam_watch.hpp"
#include "accel/beam/shared_beam_run.hpp"
#include "accel/core/registry.hpp"

namespace beambench::accel::grid_beam {

void GridBeam::trace(const PrimaryRays& rays, HitBuffer& buffer, WorkCounters* counters) const {
  if (counters != nullptr) {
    beam::CountingBeamWatch watch(*counters);
    return trace_watched(rays, buffer, watch);
  }
  beam::NoBeamWatch watch;
  trace_watched(rays, buffer, watch);
}

void GridBeam::trace_shared(const PrimaryRays& rays, HitBuffer& buffer,
                            WorkCounters* counters) const {
  if (counters != nullptr) {
    return beam::SharedBeamRun<beam::CountingBeamWatch, GridCells>(*scene_, cells(), rules_, rays,
                                                                   buffer)(*counters);
  }
  NoCounting none;
  beam::SharedBeamRun<beam::NoBeamWatch, GridCells>(*scene_, cells(), rules_, rays, buffer)(none);
}

std::vector<BeamOutline> GridBeam::beam_outlines(const PrimaryRays& rays) const {
  beam::OutlineBeamWatch watch(rays.width(), rays.height());
  HitBuffer buffer(rays.width(), rays.height(), rays.samples());
  trace_watched(rays, buffer, watch);
  return std::move(watch).take();
}

Statistics GridBeam::statistics() const {
  Statistics statistics = GridCells::Tracer::statistics();
  statistics.bytes += lattice_.bytes();
  statistics.image_rays = ImageRays::kOwn;
  return statistics;
}

void register_grid_beam(Registry& registry) {
  registry.add({"grid-beam",
                "the thesis's beams of primary rays through a hierarchy of grids, its future work "
                "(section 7.3): individual rays where a beam meets objects or has few samples",
                Conformance::kBitExact, GridBeamOptions::parameters(),
                [](const scenes::Scene& scene, const Parameters& parameters, const Workload&) {
                  return std::make_unique<GridBeam>(scene, GridBeamOptions::from(parameters));
                }});
  registry.describe_counters("grid-beam", beam::beam_counters());
}

}  // namespace beambench::accel::grid_beam
