#include "accel/embree/native_scene.hpp"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <tbb/global_control.h>

#include "accel/core/threads.hpp"
#include "accel/embree/isa.hpp"

namespace beambench::accel::embree {
namespace {

/// Creates a buffer of `count` elements to be filled. A scene's own array cannot be shared, because
/// Embree reads 16 bytes at every vertex, and the last element may be at the end of a page.
template <class Element>
Element* new_buffer(const GeometryHandle& geometry, RTCBufferType type, RTCFormat format,
                    std::size_t count) {
  return static_cast<Element*>(
      rtcSetNewGeometryBuffer(geometry.get(), type, 0, format, sizeof(Element), count));
}

/// Returns whether the list is 0, 1, 2...
bool is_count(const std::vector<scenes::PrimitiveId>& ids) {
  scenes::PrimitiveId expected = 0;
  return std::ranges::all_of(ids, [&](scenes::PrimitiveId id) { return id == expected++; });
}

/// Normalizes a ray's direction, multiplies the ray's t by the former length, and returns that
/// length.
float make_unit(RTCRay& ray) {
  const float length = glm::length(glm::vec3(ray.dir_x, ray.dir_y, ray.dir_z));
  ray.dir_x /= length;
  ray.dir_y /= length;
  ray.dir_z /= length;
  ray.tnear *= length;
  ray.tfar *= length;
  return length;
}

}  // namespace

NativeScene::NativeScene(const scenes::Scene& scene, RTCBuildQuality quality, bool robust,
                         const std::string& isa, ConeGeometry cones, int threads, bool moves)
    : device_(device_config(isa, thread_count(threads)).c_str()),
      user_(scene, cones),
      scene_(rtcNewScene(device_.get())) {
  // Embree uses the largest thread count of all its living devices; this limits it to one.
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  // Only scenes of low quality have a hierarchy for each geometry, which Embree then refits.
  rtcSetSceneBuildQuality(scene_.get(), moves ? RTC_BUILD_QUALITY_LOW : quality);
  int flags = robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE;
  if (moves) flags |= RTC_SCENE_FLAG_DYNAMIC;
  rtcSetSceneFlags(scene_.get(), static_cast<RTCSceneFlags>(flags));
  if (moves) quality = RTC_BUILD_QUALITY_REFIT;  // from here on, quality of the geometries

  owners_.ids.reserve(scene.triangles.size() + scene.spheres.size() + scene.cones.size());
  for (const scenes::Triangle& triangle : scene.triangles)
    owners_.ids.push_back(triangle.primitive);
  if (!scene.triangles.empty()) attach(kTriangles, make_triangles(scene), quality);

  const auto append = [&](scenes::PrimitiveKind kind) {
    for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
      const scenes::Primitive& primitive = scene.primitives[id];
      if (primitive.kind == kind && !is_user_primitive(scene, primitive, cones)) {
        owners_.ids.push_back(id);
      }
    }
    return static_cast<std::uint32_t>(owners_.ids.size());
  };
  owners_.first[kSpheres] = static_cast<std::uint32_t>(owners_.ids.size());
  owners_.first[kCurves] = append(scenes::PrimitiveKind::kSphere);
  owners_.first[kUser] = append(scenes::PrimitiveKind::kCone);
  if (sphere_count() > 0) attach(kSpheres, make_spheres(scene), quality);
  if (curve_count() > 0) attach(kCurves, make_curves(scene), quality);

  owners_.ids.insert(owners_.ids.end(), user_.ids().begin(), user_.ids().end());
  if (user_count() > 0) attach(kUser, user_.make(device_.get()), quality);
  owners_.in_order = is_count(owners_.ids);

  rtcCommitScene(scene_.get());
  device_.check("building over " + scene.name);
}

std::optional<Hit> NativeScene::closest_hit(Context& context, const Ray& ray) const {
  RTCRayHit query = to_embree_query(ray);
  const float length = curve_count() == 0 ? 1.0F : make_unit(query.ray);
  intersect(scene_.get(), context, query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return Hit{query.ray.tfar / length, owner(query.hit.geomID, query.hit.primID)};
}

bool NativeScene::any_hit(Context& context, const Ray& ray) const {
  RTCRay query = to_embree(ray);
  if (curve_count() != 0) make_unit(query);
  return occluded(scene_.get(), context, query);
}

void NativeScene::attach(GeometryId id, const GeometryHandle& geometry, RTCBuildQuality quality) {
  rtcSetGeometryBuildQuality(geometry.get(), quality);  // needed to make low quality fast
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometryByID(scene_.get(), geometry.get(), id);
}

GeometryHandle NativeScene::make_triangles(const scenes::Scene& scene) {
  GeometryHandle geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
  auto* const vertices = new_buffer<glm::vec3>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3,
                                               scene.vertices.size());
  device_.check("building over " + scene.name);
  std::memcpy(vertices, scene.vertices.data(), scene.vertices.size() * sizeof(glm::vec3));
  // A triangle's indices come before its owner, so that this array can be shared.
  rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                             scene.triangles.data(), 0, sizeof(scenes::Triangle),
                             scene.triangles.size());
  return geometry;
}

GeometryHandle NativeScene::make_spheres(const scenes::Scene& scene) {
  GeometryHandle geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_SPHERE_POINT));
  auto* const points =
      new_buffer<glm::vec4>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, sphere_count());
  device_.check("building over " + scene.name);
  copy_spheres(scene, points);
  return geometry;
}

void NativeScene::copy_spheres(const scenes::Scene& scene, glm::vec4* points) const {
  for (std::size_t i = 0; i < sphere_count(); ++i) {
    const scenes::PrimitiveId id = owners_.ids[owners_.first[kSpheres] + i];
    const scenes::Sphere& sphere = scene.spheres[scene.primitives[id].index];
    points[i] = glm::vec4(sphere.center, sphere.radius);
  }
}

GeometryHandle NativeScene::make_curves(const scenes::Scene& scene) {
  GeometryHandle geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_CONE_LINEAR_CURVE));
  auto* const ends =
      new_buffer<glm::vec4>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 2 * curve_count());
  auto* const first_ends =
      new_buffer<unsigned>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT, curve_count());
  device_.check("building over " + scene.name);
  copy_curves(scene, ends);
  for (std::size_t i = 0; i < curve_count(); ++i) first_ends[i] = static_cast<unsigned>(2 * i);
  return geometry;
}

void NativeScene::copy_curves(const scenes::Scene& scene, glm::vec4* ends) const {
  for (std::size_t i = 0; i < curve_count(); ++i) {
    const scenes::PrimitiveId id = owners_.ids[owners_.first[kCurves] + i];
    const scenes::Cone& cone = scene.cones[scene.primitives[id].index];
    ends[2 * i] = glm::vec4(cone.base, cone.base_radius);
    ends[2 * i + 1] = glm::vec4(cone.apex, cone.apex_radius);
  }
}

void NativeScene::update(const scenes::Scene& scene) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const auto renew = [&](GeometryId id, const auto& copy) {
    const RTCGeometry geometry = rtcGetGeometry(scene_.get(), id);
    copy(geometry);
    rtcCommitGeometry(geometry);
  };
  const auto renew_vertices = [&](GeometryId id, const auto& copy) {
    renew(id, [&](RTCGeometry geometry) {
      copy(rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_VERTEX, 0));
      rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
    });
  };
  if (!scene.triangles.empty()) {
    renew_vertices(kTriangles, [&](void* vertices) {
      std::memcpy(vertices, scene.vertices.data(), scene.vertices.size() * sizeof(glm::vec3));
    });
  }
  if (sphere_count() > 0) {
    renew_vertices(kSpheres,
                   [&](void* points) { copy_spheres(scene, static_cast<glm::vec4*>(points)); });
  }
  if (curve_count() > 0) {
    renew_vertices(kCurves, [&](void* ends) { copy_curves(scene, static_cast<glm::vec4*>(ends)); });
  }
  if (user_count() > 0) {
    user_.measure(scene);
    renew(kUser, [](RTCGeometry) {});
  }
  rtcCommitScene(scene_.get());
  device_.check("updating over " + scene.name);
}

std::string NativeScene::geometry_types() const {
  std::vector<const char*> types;
  if (triangle_count() > 0) types.push_back("triangles");
  if (sphere_count() > 0) types.push_back("points");
  if (curve_count() > 0) types.push_back("curves");
  if (user_count() > 0) types.push_back("callbacks");
  return fmt::format("{}", fmt::join(types, "+"));
}

std::uint64_t NativeScene::bytes() const {
  return device_.bytes() + owners_.ids.capacity() * sizeof(scenes::PrimitiveId) +
         user_.ids().capacity() * sizeof(scenes::PrimitiveId);
}

}  // namespace beambench::accel::embree
