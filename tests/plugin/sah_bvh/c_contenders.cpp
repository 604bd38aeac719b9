// The program's own sah-bvh behind the C interface, to measure what the interface costs.

#include <memory>
#include <span>

#include "accel/core/registry.hpp"
#include "harness/plugin/c/beambench/contender.h"

namespace {

using namespace beambench;

/// A scene made from the arrays of the C interface, and the structure over it.
struct Wrapped {
  scenes::Scene scene;
  std::unique_ptr<accel::Accelerator> structure{};
};

/// Returns a scene of polygons, one for each primitive.
scenes::Scene scene_of(const beambench_scene& given) {
  scenes::Scene scene;
  scene.cameras.emplace_back();
  const auto* vertices = reinterpret_cast<const glm::vec3*>(given.vertices);
  const auto* triangles = reinterpret_cast<const scenes::Triangle*>(given.triangles);
  scene.vertices.assign(vertices, vertices + given.vertex_count);
  scene.triangles.assign(triangles, triangles + given.triangle_count);
  for (const glm::vec3& vertex : scene.vertices) scene.bounds.include(vertex);
  for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
    if (scene.triangles[i].primitive == scene.polygons.size()) {
      scene.primitives.push_back(
          {scenes::PrimitiveKind::kPolygon, static_cast<std::uint32_t>(scene.polygons.size()), 0});
      scene.polygons.push_back({0, 3, i, 0, scenes::Polygon::kFlat});
    }
    ++scene.polygons.back().triangle_count;
  }
  return scene;
}

int create(const beambench_scene* given, const char* spec, void** structure) {
  auto made = std::make_unique<Wrapped>(scene_of(*given));
  made->structure = accel::registry().choose_list(spec).front().build(made->scene);
  *structure = made.release();
  return BEAMBENCH_OK;
}
int create_single(const beambench_scene* given, void** structure) {
  return create(given, "sah-bvh:lists=single", structure);
}
int create_streams(const beambench_scene* given, void** structure) {
  return create(given, "sah-bvh", structure);
}

std::span<const accel::Ray> rays_of(const beambench_batch& batch) {
  return {reinterpret_cast<const accel::Ray*>(batch.rays), batch.count};
}

const accel::Accelerator& wrapped(const void* structure) {
  return *static_cast<const Wrapped*>(structure)->structure;
}

int closest_hits(const void* structure, const beambench_batch* batch, float* t,
                 std::uint32_t* primitive) {
  wrapped(structure).closest_hits(accel::RayBatch{rays_of(*batch)},
                                  accel::HitSpan(t, primitive, batch->count), {});
  return BEAMBENCH_OK;
}
int any_hits(const void* structure, const beambench_batch* batch, std::uint8_t* hits) {
  wrapped(structure).any_hits(accel::RayBatch{rays_of(*batch)}, {hits, batch->count}, {});
  return BEAMBENCH_OK;
}
void destroy(void* structure) { delete static_cast<Wrapped*>(structure); }

constexpr beambench_contender kContenders[]{
    {sizeof(beambench_contender), "c-sah-bvh-single", "sah-bvh:lists=single behind the C interface",
     nullptr, BEAMBENCH_TRIANGLES, create_single, closest_hits, any_hits, destroy, nullptr},
    {sizeof(beambench_contender), "c-sah-bvh", "sah-bvh behind the C interface", nullptr,
     BEAMBENCH_TRIANGLES, create_streams, closest_hits, any_hits, destroy, nullptr}};

}  // namespace

const beambench_contender* beambench_contenders(std::uint32_t version, std::uint32_t* count) {
  *count = version == BEAMBENCH_C_INTERFACE ? 2 : 0;
  return kContenders;
}
