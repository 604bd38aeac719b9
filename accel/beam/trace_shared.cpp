#include "accel/beam/beam_tracer.hpp"
#include "accel/beam/shared_beam_run.hpp"

namespace beambench::accel::beam {

void BeamTracer::trace_shared(const PrimaryRays& rays, HitBuffer& buffer,
                              WorkCounters* counters) const {
  if (counters != nullptr) {
    return SharedBeamRun<CountingBeamWatch>(*scene_, *this, options_, rays, buffer)(*counters);
  }
  NoCounting none;
  SharedBeamRun<NoBeamWatch>(*scene_, *this, options_, rays, buffer)(none);
}

}  // namespace beambench::accel::beam
