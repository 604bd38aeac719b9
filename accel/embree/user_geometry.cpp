#include "accel/embree/user_geometry.hpp"

#include <optional>

#include <glm/geometric.hpp>

#include "accel/oracle/exact_tests.hpp"

namespace beambench::accel::embree {
namespace {

/// Embree's float boxes must be valid for cameras up to this many scene sizes away, the limit up to
/// which structures are exact (accel/core/tolerance.hpp).
constexpr double kCameraDistance = 8.0;

Ray ray_of(RTCRayN* rays, unsigned n, unsigned i) {
  Ray ray;
  ray.origin = {RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i), RTCRayN_org_z(rays, n, i)};
  ray.direction = {RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i)};
  ray.t_min = RTCRayN_tnear(rays, n, i);
  ray.t_max = RTCRayN_tfar(rays, n, i);
  return ray;
}

std::optional<double> hit(const scenes::Scene& scene, scenes::PrimitiveId id, const Ray& ray) {
  const scenes::Primitive& primitive = scene.primitives[id];
  const oracle::ExactRay exact(ray);
  return primitive.kind == scenes::PrimitiveKind::kCone
             ? oracle::first_hit(exact, scene.cones[primitive.index])
             : oracle::first_hit(exact, scene.spheres[primitive.index]);
}

}  // namespace

bool is_user_primitive(const scenes::Scene& scene, const scenes::Primitive& primitive,
                       ConeGeometry cones) {
  switch (primitive.kind) {
    case scenes::PrimitiveKind::kCone:
      return cones == ConeGeometry::kCallbacks || scene.cones[primitive.index].inside_only;
    case scenes::PrimitiveKind::kSphere:
      return scene.spheres[primitive.index].inside_only;
    case scenes::PrimitiveKind::kPolygon:
      break;
  }
  return false;
}

UserGeometry::UserGeometry(const scenes::Scene& scene, ConeGeometry cones) : scene_(scene) {
  measure(scene);
  for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    if (is_user_primitive(scene, scene.primitives[id], cones)) ids_.push_back(id);
  }
}

void UserGeometry::measure(const scenes::Scene& scene) {
  pad_ = static_cast<float>(4.0 * 0x1p-23 *
                            (scene.bounds.largest_coordinate() +
                             kCameraDistance * glm::length(glm::dvec3(scene.bounds.extent()))));
}

GeometryHandle UserGeometry::make(RTCDevice device) {
  GeometryHandle geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER));
  rtcSetGeometryUserPrimitiveCount(geometry.get(), static_cast<unsigned>(ids_.size()));
  rtcSetGeometryUserData(geometry.get(), this);
  rtcSetGeometryBoundsFunction(geometry.get(), on_bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry.get(), on_intersect);
  rtcSetGeometryOccludedFunction(geometry.get(), on_occluded);
  return geometry;
}

void UserGeometry::on_bounds(const RTCBoundsFunctionArguments* arguments) {
  const auto& self = *static_cast<const UserGeometry*>(arguments->geometryUserPtr);
  const scenes::Bounds bounds = scenes::primitive_bounds(self.scene_, self.ids_[arguments->primID]);
  const glm::vec3 lower = bounds.lower - self.pad_;
  const glm::vec3 upper = bounds.upper + self.pad_;
  *arguments->bounds_o = {lower.x, lower.y, lower.z, 0.0F, upper.x, upper.y, upper.z, 0.0F};
}

// For Embree 4, `valid` must state which rays hit something; Embree 3 passes a copy and ignores it.

void UserGeometry::on_intersect(const RTCIntersectFunctionNArguments* arguments) {
  const auto& self = *static_cast<const UserGeometry*>(arguments->geometryUserPtr);
  const unsigned n = arguments->N;
  RTCRayN* const rays = RTCRayHitN_RayN(arguments->rayhit, n);
  RTCHitN* const hits = RTCRayHitN_HitN(arguments->rayhit, n);
  for (unsigned i = 0; i < n; ++i) {
    if (arguments->valid[i] == 0) continue;
    const std::optional<double> t =
        hit(self.scene_, self.ids_[arguments->primID], ray_of(rays, n, i));
    if (!t) {
      arguments->valid[i] = 0;
      continue;
    }
    RTCRayN_tfar(rays, n, i) = static_cast<float>(*t);
    RTCHitN_geomID(hits, n, i) = arguments->geomID;
    RTCHitN_primID(hits, n, i) = arguments->primID;
  }
}

void UserGeometry::on_occluded(const RTCOccludedFunctionNArguments* arguments) {
  const auto& self = *static_cast<const UserGeometry*>(arguments->geometryUserPtr);
  const unsigned n = arguments->N;
  for (unsigned i = 0; i < n; ++i) {
    if (arguments->valid[i] == 0) continue;
    if (hit(self.scene_, self.ids_[arguments->primID], ray_of(arguments->ray, n, i))) {
      RTCRayN_tfar(arguments->ray, n, i) = -kInfinity;
    } else {
      arguments->valid[i] = 0;
    }
  }
}

}  // namespace beambench::accel::embree
