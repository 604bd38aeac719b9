#include "accel/embree/version.hpp"

#include <fmt/format.h>

#include "accel/embree/device.hpp"
#include "accel/embree/isa.hpp"

namespace beambench::accel::embree {

std::string embree_version() {
  const embree::Device device("threads=1");
  const auto part = [&](RTCDeviceProperty property) {
    return static_cast<long>(rtcGetDeviceProperty(device.get(), property));
  };
  return fmt::format("{}.{}.{}", part(RTC_DEVICE_PROPERTY_VERSION_MAJOR),
                     part(RTC_DEVICE_PROPERTY_VERSION_MINOR),
                     part(RTC_DEVICE_PROPERTY_VERSION_PATCH));
}

std::string embree_isa() { return embree::isa_in_use("best"); }

}  // namespace beambench::accel::embree
