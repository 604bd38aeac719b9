// Traces images in beams, on one thread or several.

#include "accel/beam/beam_tracer.hpp"
#include "accel/beam/shared_beam_run.hpp"

namespace beambench::accel::beam {

void BeamTracer::closest_hits(const RaySource& rays, const HitSpan& hits,
                              const QueryContext& context) const {
  if (const PrimaryRays* image = rays.image()) return trace_image(*image, hits, context);
  if (const RayBatch* batch = rays.batch()) return trace_batch(*batch, hits, context.counters);
  octree::Samet::closest_hits(rays, hits, context);
}

void BeamTracer::trace_image(const PrimaryRays& rays, const HitSpan& hits,
                             const QueryContext& context) const {
  trace_image_in_beams(*scene_, OctreeCells(*this), options_, rays, hits, context);
}

}  // namespace beambench::accel::beam
