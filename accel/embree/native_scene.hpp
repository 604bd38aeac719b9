#pragma once
// A scene in Embree's native geometry types.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec4.hpp>

#include "accel/core/ray.hpp"
#include "accel/embree/user_geometry.hpp"
#include "accel/embree_api/api.hpp"
#include "accel/embree_api/device.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::embree {

/// The ids of the geometries in Embree.
enum GeometryId : unsigned { kTriangles, kSpheres, kCurves, kUser, kGeometryCount };

/// The owners of Embree's primitives: primitives of the scene.
struct OwnerTable {
  /// The scene's ids for the geometries' primitives, one geometry after the other.
  std::vector<scenes::PrimitiveId> ids;
  /// The beginning of each geometry in `ids`.
  std::array<std::uint32_t, kGeometryCount> first{};
  bool in_order = false;  ///< ids[i] is i, so no look-up is needed
};

/// A scene in Embree: polygons are triangles (the scene's own triangulation), hollow spheres are
/// sphere points, cones are optionally linear curves, and all other primitives are user geometry.
/// It has its own device with one build thread, so that build times are comparable with those of
/// single-threaded builds and memory is counted exactly. Creating the device, 0.05 ms, is part of
/// the build.
class NativeScene {
 public:
  /// `isa` is a value of `isa_parameter`; `cones` selects the cones that Embree's curves test.
  /// During the scene's lifetime, TBB has at most `threads` threads (`thread_count`).
  /// `moves`: for scenes whose coordinates change (`update`).
  NativeScene(const scenes::Scene& scene, RTCBuildQuality quality, bool robust,
              const std::string& isa, ConeGeometry cones, int threads = 1, bool moves = false);

  /// Copies the coordinates of the scene, which must have the same primitives, and has Embree refit
  /// its hierarchies.
  void update(const scenes::Scene& scene);

  RTCScene get() const { return scene_.get(); }
  /// Returns the hit of one ray, which must pass `require_valid`. Embree's packets give the same
  /// hit.
  std::optional<Hit> closest_hit(Context& context, const Ray& ray) const;
  bool any_hit(Context& context, const Ray& ray) const;
  /// Returns the primitive that was hit, or kNoPrimitive for RTC_INVALID_GEOMETRY_ID.
  scenes::PrimitiveId owner(unsigned geometry, unsigned primitive) const {
    return geometry == RTC_INVALID_GEOMETRY_ID ? scenes::kNoPrimitive
                                               : owners_.ids[owners_.first[geometry] + primitive];
  }
  /// Returns the table for looking up the owners of many hits at once.
  const OwnerTable& owners() const { return owners_; }

  std::size_t triangle_count() const { return owners_.first[kSpheres]; }
  std::size_t sphere_count() const { return owners_.first[kCurves] - owners_.first[kSpheres]; }
  /// Returns the number of curves. If there are any, rays must have directions of unit length:
  /// Embree 3 assumes unit length for rays that meet curves
  /// (kernels/geometry/coneline_intersector.h, where the square of the length is missing in the
  /// coefficient A).
  std::size_t curve_count() const { return owners_.first[kUser] - owners_.first[kCurves]; }
  std::size_t user_count() const { return user_.ids().size(); }
  /// Returns the geometry types of the scene, joined by '+': "triangles"; "points", which are
  /// spheres; "curves", which are cones; and "callbacks" of user geometry, for other cones and for
  /// spheres seen only from the inside.
  std::string geometry_types() const;
  std::uint64_t bytes() const;

 private:
  void attach(GeometryId id, const GeometryHandle& geometry, RTCBuildQuality quality);
  GeometryHandle make_triangles(const scenes::Scene& scene);
  GeometryHandle make_spheres(const scenes::Scene& scene);
  GeometryHandle make_curves(const scenes::Scene& scene);
  void copy_spheres(const scenes::Scene& scene, glm::vec4* points) const;
  void copy_curves(const scenes::Scene& scene, glm::vec4* ends) const;

  Device device_;
  UserGeometry user_;
  SceneHandle scene_;
  OwnerTable owners_;
};

}  // namespace beambench::accel::embree
