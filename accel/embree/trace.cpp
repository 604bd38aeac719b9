#include "accel/embree/trace.hpp"

#include "accel/embree/trace_list.hpp"

namespace beambench::accel::embree {
namespace {

constexpr TraceMode kModes[] = {
    {"single", &ImageTracers::single, closest_hits_single, any_hits_single},
    {"packet4", &ImageTracers::packet4, closest_hits_by_packets<4>, any_hits_by_packets<4>},
    {"packet8", &ImageTracers::packet8, closest_hits_by_packets<8>, any_hits_by_packets<8>},
    {"packet16", &ImageTracers::packet16, closest_hits_by_packets<16>, any_hits_by_packets<16>},
#if BEAMBENCH_EMBREE_MAJOR == 3
    // Of a list there is no tile to make a stream of.
    {"stream", &ImageTracers::stream, closest_hits_by_packets<16>, any_hits_by_packets<16>},
#endif
};

}  // namespace

std::span<const TraceMode> trace_modes() { return kModes; }

}  // namespace beambench::accel::embree
