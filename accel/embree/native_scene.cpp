#include "accel/embree/native_scene.hpp"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/vec4.hpp>
#include <tbb/global_control.h>

#include "accel/embree/isa.hpp"

namespace beambench::accel::embree {
namespace {

/// A new buffer of `count` elements, to be filled. Embree reads 16 bytes at every vertex, so that a
/// scene's own array cannot be shared: its last element may end a page.
template <class Element>
Element* new_buffer(const GeometryHandle& geometry, RTCBufferType type, RTCFormat format,
                    std::size_t count) {
  return static_cast<Element*>(
      rtcSetNewGeometryBuffer(geometry.get(), type, 0, format, sizeof(Element), count));
}

/// Is it 0, 1, 2...?
bool is_count(const std::vector<scenes::PrimitiveId>& ids) {
  scenes::PrimitiveId expected = 0;
  return std::ranges::all_of(ids, [&](scenes::PrimitiveId id) { return id == expected++; });
}

}  // namespace

NativeScene::NativeScene(const scenes::Scene& scene, RTCBuildQuality quality, bool robust,
                         const std::string& isa, int threads)
    : device_(device_config(isa, threads).c_str()),
      user_(scene),
      scene_(rtcNewScene(device_.get())) {
  // Embree uses the largest thread count of all its living devices; this limits it to one.
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  rtcSetSceneBuildQuality(scene_.get(), quality);
  rtcSetSceneFlags(scene_.get(), robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);

  owners_.ids.reserve(scene.triangles.size() + scene.spheres.size() + scene.cones.size());
  for (const scenes::Triangle& triangle : scene.triangles)
    owners_.ids.push_back(triangle.primitive);
  if (!scene.triangles.empty()) attach(kTriangles, make_triangles(scene), quality);

  owners_.first[kSpheres] = static_cast<std::uint32_t>(owners_.ids.size());
  for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    const scenes::Primitive& primitive = scene.primitives[id];
    if (primitive.kind == scenes::PrimitiveKind::kSphere && !is_user_primitive(scene, primitive)) {
      owners_.ids.push_back(id);
    }
  }
  owners_.first[kUser] = static_cast<std::uint32_t>(owners_.ids.size());
  if (sphere_count() > 0) attach(kSpheres, make_spheres(scene), quality);

  owners_.ids.insert(owners_.ids.end(), user_.ids().begin(), user_.ids().end());
  if (user_count() > 0) attach(kUser, user_.make(device_.get()), quality);
  owners_.in_order = is_count(owners_.ids);

  rtcCommitScene(scene_.get());
  device_.check("building over " + scene.name);
}

void NativeScene::attach(GeometryId id, const GeometryHandle& geometry, RTCBuildQuality quality) {
  rtcSetGeometryBuildQuality(geometry.get(), quality);  // needed for low quality to be fast
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
  for (std::size_t i = 0; i < sphere_count(); ++i) {
    const scenes::PrimitiveId id = owners_.ids[owners_.first[kSpheres] + i];
    const scenes::Sphere& sphere = scene.spheres[scene.primitives[id].index];
    points[i] = glm::vec4(sphere.center, sphere.radius);
  }
  return geometry;
}

std::string NativeScene::geometry_types() const {
  std::vector<const char*> types;
  if (triangle_count() > 0) types.push_back("triangles");
  if (sphere_count() > 0) types.push_back("points");
  if (user_count() > 0) types.push_back("callbacks");
  return fmt::format("{}", fmt::join(types, "+"));
}

std::uint64_t NativeScene::bytes() const {
  return device_.bytes() + owners_.ids.capacity() * sizeof(scenes::PrimitiveId) +
         user_.ids().capacity() * sizeof(scenes::PrimitiveId);
}

}  // namespace beambench::accel::embree
