#pragma once
// A scene of ours in Embree's native geometry types.

#include <array>
#include <cstdint>
#include <vector>

#include "accel/embree/device.hpp"
#include "accel/embree/user_geometry.hpp"
#include "scenes/scene.hpp"

namespace beambench::embree {

/// Polygons are Embree triangles (the scene's own triangulation), hollow spheres are sphere points,
/// the rest is user geometry. The device is its own, with one build thread, so that build times
/// compare with structures that build on one and memory is counted exactly. Making the device is
/// part of the build: 0.05 ms.
class NativeScene {
 public:
  NativeScene(const Scene& scene, RTCBuildQuality quality, bool robust);

  RTCScene get() const { return scene_.get(); }
  /// Whose the hit is; kNoPrimitive for RTC_INVALID_GEOMETRY_ID.
  PrimitiveId owner(unsigned geometry, unsigned primitive) const {
    return geometry == RTC_INVALID_GEOMETRY_ID ? kNoPrimitive
                                               : owners_[first_owner_[geometry] + primitive];
  }

  std::size_t triangle_count() const { return first_owner_[kSpheres]; }
  std::size_t sphere_count() const { return first_owner_[kUser] - first_owner_[kSpheres]; }
  std::size_t user_count() const { return user_.ids().size(); }
  std::uint64_t bytes() const;

 private:
  enum GeometryId : unsigned { kTriangles, kSpheres, kUser, kGeometryCount };

  void attach(GeometryId id, const GeometryHandle& geometry, RTCBuildQuality quality);
  GeometryHandle make_triangles(const Scene& scene);
  GeometryHandle make_spheres(const Scene& scene);

  Device device_;
  UserGeometry user_;
  SceneHandle scene_;
  /// Primitive ids of the three geometries' primitives, one geometry after the other.
  std::vector<PrimitiveId> owners_;
  std::array<std::size_t, kGeometryCount> first_owner_{};
};

}  // namespace beambench::embree
