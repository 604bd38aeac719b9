#include "accel/embree/trace_modes.hpp"

namespace beambench::accel::embree {

std::span<const TraceMode> trace_modes() {
  static constexpr TraceMode kModes[] = {
    {"single", &ImageTracers::single, &ListTracers::single},
    {"packet4", &ImageTracers::packet4, &ListTracers::packet4},
    {"packet8", &ImageTracers::packet8, &ListTracers::packet8},
    {"packet16", &ImageTracers::packet16, &ListTracers::packet16},
#if BEAMBENCH_EMBREE_MAJOR == 3
    {"stream", &ImageTracers::stream, &ListTracers::stream},
#endif
  };
  return kModes;
}

}  // namespace beambench::accel::embree
