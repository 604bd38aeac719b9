#pragma once
// User geometry for primitives that no geometry type of Embree represents: spheres seen only from
// the inside, and cones, which are open at both ends, unless they are represented as curves.

#include <vector>

#include "accel/embree_api/device.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::embree {

/// The representation of cones in Embree: tested exactly by callbacks, or as linear curves, which
/// are closed by disks at both ends and tested in single precision. Cones seen from the inside only
/// are always tested by callbacks.
enum class ConeGeometry { kCallbacks, kCurves };

/// The user primitives of a scene. Embree's callbacks refer to this object, so it must not move.
class UserGeometry {
 public:
  UserGeometry(const scenes::Scene& scene, ConeGeometry cones);
  UserGeometry(const UserGeometry&) = delete;
  UserGeometry& operator=(const UserGeometry&) = delete;
  ~UserGeometry() = default;

  /// Returns the ids, indexed by the primitive number that Embree reports.
  const std::vector<scenes::PrimitiveId>& ids() const { return ids_; }
  /// Creates a geometry over the primitives, which must outlive it; it is not yet committed.
  GeometryHandle make(RTCDevice device);
  /// Computes the boxes' padding from the scene's current bounds.
  void measure(const scenes::Scene& scene);

 private:
  static void on_bounds(const RTCBoundsFunctionArguments* arguments);
  static void on_intersect(const RTCIntersectFunctionNArguments* arguments);
  static void on_occluded(const RTCOccludedFunctionNArguments* arguments);

  const scenes::Scene& scene_;
  std::vector<scenes::PrimitiveId> ids_;
  float pad_;
};

/// Returns whether `primitive` becomes part of a scene's user geometry.
bool is_user_primitive(const scenes::Scene& scene, const scenes::Primitive& primitive,
                       ConeGeometry cones);

}  // namespace beambench::accel::embree
