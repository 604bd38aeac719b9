#pragma once
// Owners of Embree's objects.

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "accel/embree_api/api.hpp"

namespace beambench::accel::embree {

/// An Embree device that records Embree's errors and memory use. Embree calls back from C functions
/// and from its own threads, which exceptions cannot cross: errors are kept until `check`.
class Device {
 public:
  /// Creates a device; `config` is passed to rtcNewDevice, for example "threads=1". Throws
  /// std::runtime_error if Embree refuses.
  explicit Device(const char* config);
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  ~Device();

  RTCDevice get() const { return device_; }
  /// Throws the first error since the last check: InputError if memory ran out, otherwise
  /// std::runtime_error. `doing` describes the attempted action: "building over balls:n=4".
  void check(const std::string& doing);
  /// Returns the memory that Embree holds for this device.
  std::uint64_t bytes() const;

 private:
  struct Failure {
    RTCError code;
    std::string text;
  };
  static void on_error(void* self, RTCError code, const char* text);
  static bool on_memory(void* self, ssize_t bytes, bool post);

  RTCDevice device_;
  std::mutex mutex_;
  std::optional<Failure> failure_;
  std::atomic<std::int64_t> bytes_{0};
};

struct ReleaseScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
struct ReleaseGeometry {
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using SceneHandle = std::unique_ptr<RTCSceneTy, ReleaseScene>;
using GeometryHandle = std::unique_ptr<RTCGeometryTy, ReleaseGeometry>;

}  // namespace beambench::accel::embree
