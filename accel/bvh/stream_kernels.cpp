#include "accel/bvh/stream_kernels.hpp"

#include "accel/bvh/stream_memory.hpp"
#include "accel/core/pick_target.hpp"

// Highway includes this file again for each instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "accel/bvh/stream_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "accel/bvh/stream_walk-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::bvh::HWY_NAMESPACE {

template <bool kAny, class Counting>
void trace(const Stream& stream, std::vector<std::uint32_t>& left, Counting& counting) {
  StreamMemory& memory = StreamMemory::of_thread();
  memory.reserve(stream.rays.size());
  StreamWalk<kAny, Counting>(stream, memory, left, counting);
}

template <class Counting>
constexpr StreamQueries<Counting> queries() {
  return {trace<false, Counting>, trace<true, Counting>};
}

const StreamKernels& stream_kernels() {
  static constexpr StreamKernels kKernels{queries<NoCounting>(), queries<WorkCounters>()};
  return kKernels;
}

}  // namespace beambench::accel::bvh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace beambench::accel::bvh {

HWY_EXPORT(stream_kernels);

const StreamKernels& stream_kernels_for(std::int64_t targets) {
  return pick_target(HWY_DISPATCH_TABLE(stream_kernels), targets)();
}

}  // namespace beambench::accel::bvh
#endif
