#pragma once
// Primitives that Embree has no type for, as its user geometry: cones, and spheres that are seen
// from the inside only.

#include <vector>

#include "accel/embree/device.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::embree {

/// The user primitives of a scene; Embree calls back into it, so it may not move.
class UserGeometry {
 public:
  explicit UserGeometry(const scenes::Scene& scene);
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
bool is_user_primitive(const scenes::Scene& scene, const scenes::Primitive& primitive);

}  // namespace beambench::accel::embree
