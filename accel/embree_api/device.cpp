#include "accel/embree_api/device.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "scenes/base/error.hpp"

namespace beambench::accel::embree {

Device::Device(const char* config) : device_(rtcNewDevice(config)) {
  if (device_ == nullptr) {
    throw std::runtime_error(
        fmt::format("Embree could not create a device with the configuration '{}' (error {})",
                    config, static_cast<int>(rtcGetDeviceError(nullptr))));
  }
  rtcSetDeviceErrorFunction(device_, on_error, this);
  rtcSetDeviceMemoryMonitorFunction(device_, on_memory, this);
}

Device::~Device() { rtcReleaseDevice(device_); }

void Device::on_error(void* self, RTCError code, const char* text) {
  auto& device = *static_cast<Device*>(self);
  const std::lock_guard lock(device.mutex_);
  if (!device.failure_) device.failure_ = Failure{code, text == nullptr ? "" : text};
}

bool Device::on_memory(void* self, ssize_t bytes, bool /*post*/) {
  static_cast<Device*>(self)->bytes_.fetch_add(bytes, std::memory_order_relaxed);
  return true;
}

void Device::check(const std::string& doing) {
  std::optional<Failure> failure;
  {
    const std::lock_guard lock(mutex_);
    failure.swap(failure_);
  }
  if (!failure) return;
  if (failure->code == RTC_ERROR_OUT_OF_MEMORY) {
    throw InputError(
        fmt::format("Embree ran out of memory while {}; choose a smaller scene", doing));
  }
  throw std::runtime_error(fmt::format("Embree failed while {}: {} (error {})", doing,
                                       failure->text, static_cast<int>(failure->code)));
}

std::uint64_t Device::bytes() const {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(0, bytes_.load()));
}

}  // namespace beambench::accel::embree
