// Lists of rays: reflections in planar mirrors are traced in beams, the others one by one.

#include <cstddef>
#include <type_traits>

#include "accel/beam/beam_tracer.hpp"

namespace beambench::accel::beam {

void BeamTracer::trace_batch(const RayBatch& batch, const HitSpan& buffer,
                             WorkCounters* counters) const {
  with_counting(counters, [&](auto& counting) {
    const auto singly = [&](std::size_t begin, std::size_t end) {
      for (; begin < end; ++begin) buffer.set(begin, find_closest(batch.rays[begin], counting));
    };
    std::size_t next = 0;
    for (const Pencil& pencil : batch.pencils) {
      if (!BehindMirror::suits(batch, pencil)) continue;
      singly(next, pencil.first);
      trace_mirror(batch, pencil, buffer, counting);
      next = pencil.first + pencil.count;
    }
    singly(next, batch.rays.size());
  });
}

template <class Counting>
void BeamTracer::trace_mirror(const RayBatch& batch, const Pencil& pencil, const HitSpan& buffer,
                              Counting& counting) const {
  const BehindMirror mirror(batch, pencil, *scene_, octree());
  HitBuffer seen = mirror.buffer();
  std::vector<std::uint8_t> finished = mirror.finished();
  const auto trace = [&](auto watch) {
    BeamRun<decltype(watch), BehindMirror>(*scene_, *this, options_, *pencil.view, mirror, seen,
                                           finished, watch)();
  };
  if constexpr (std::is_same_v<Counting, WorkCounters>) {
    trace(CountingBeamWatch(counting));
  } else {
    trace(NoBeamWatch());
  }
  std::size_t index = pencil.first;
  for (const std::uint32_t place : mirror.places()) {
    const bool in_beam = place != BehindMirror::kNone && finished[place] != 0;
    buffer.set(index, in_beam ? seen.get(place) : find_closest(batch.rays[index], counting));
    ++index;
  }
}

}  // namespace beambench::accel::beam
