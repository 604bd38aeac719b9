#pragma once
// Primitives that Embree has no type for, as its user geometry: spheres that are seen from the
// inside only, and cones, whose ends are open, unless they are taken as its curves.

#include <vector>

#include "accel/embree_api/device.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::embree {

/// How cones are given to Embree: tested exactly by callbacks, or as its linear curves, which are
/// closed by disks at both ends and tested in single precision. Those seen from the inside only are
/// tested by callbacks in any case.
enum class ConeGeometry { kCallbacks, kCurves };

/// The user primitives of a scene; Embree calls back into it, so it may not move.
class UserGeometry {
 public:
  UserGeometry(const scenes::Scene& scene, ConeGeometry cones);
  UserGeometry(const UserGeometry&) = delete;
  UserGeometry& operator=(const UserGeometry&) = delete;
  ~UserGeometry() = default;

  /// By the primitive number that Embree reports.
  const std::vector<scenes::PrimitiveId>& ids() const { return ids_; }
  /// A geometry over them, not yet committed; they must outlive it.
  GeometryHandle make(RTCDevice device);

 private:
  static void on_bounds(const RTCBoundsFunctionArguments* arguments);
  static void on_intersect(const RTCIntersectFunctionNArguments* arguments);
  static void on_occluded(const RTCOccludedFunctionNArguments* arguments);

  const scenes::Scene& scene_;
  std::vector<scenes::PrimitiveId> ids_;
  float pad_;
};

/// Does `primitive` go into the user geometry of a scene?
bool is_user_primitive(const scenes::Scene& scene, const scenes::Primitive& primitive,
                       ConeGeometry cones);

}  // namespace beambench::accel::embree
