#include "accel/grid_beam/grid_beam.hpp"

#include <memory>
#include <utility>

#include "accel/beam/beam_counters.hpp"
#include "accel/beam/beam_watch.hpp"
#include "accel/beam/shared_beam_run.hpp"
#include "accel/core/registry.hpp"

namespace beambench::accel::grid_beam {

void GridBeam::closest_hits(const RaySource& rays, const HitSpan& hits,
                            const QueryContext& context) const {
  if (rays.image() == nullptr) return GridCells::Tracer::closest_hits(rays, hits, context);
  beam::trace_image_in_beams(*scene_, cells(), rules_, *rays.image(), hits, context);
}

std::optional<std::vector<BeamOutline>> GridBeam::beams(const PrimaryRays& rays) const {
  beam::OutlineBeamWatch watch(rays.width(), rays.height());
  HitBuffer buffer(rays.width(), rays.height(), rays.samples());
  trace_watched(rays, buffer, watch);
  return std::move(watch).take();
}

Statistics GridBeam::statistics() const {
  Statistics statistics = GridCells::Tracer::statistics();
  statistics.bytes += lattice_.bytes();
  statistics.image_rays = ImageRays::kOwn;
  statistics.instruction_set = beam::instruction_set_of(rules_.leaf);
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
