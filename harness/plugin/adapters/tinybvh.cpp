// Jacco Bikker's tinybvh (https://github.com/jbikker/tinybvh, MIT) as a plug-in.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#define NO_THREADED_BUILDS  // one thread for everyone
#define TINYBVH_IMPLEMENTATION
#include <glm/geometric.hpp>
#include <tiny_bvh.h>

#include "scene_triangles.hpp"

namespace {

using namespace beambench;
using namespace beambench::accel;
using namespace beambench::plugin;
using namespace beambench::scenes;

tinybvh::bvhvec3 vec3(const glm::vec3& v) { return {v.x, v.y, v.z}; }

/// What a layout holds, which is also what it was made of: tinybvh frees nothing in between.
std::size_t bytes_of(const tinybvh::BVH& bvh) {
  return bvh.allocatedNodes * sizeof(tinybvh::BVH::BVHNode) +
         bvh.idxCount * (sizeof(std::uint32_t) + sizeof(tinybvh::BVHBase::Fragment));
}
std::size_t bytes_of(const tinybvh::BVH8_CPU& bvh) {
  return bvh.allocatedBlocks * sizeof(tinybvh::BVH8_CPU::CacheLine) +
         bvh.bvh8.allocatedNodes * sizeof(tinybvh::MBVH<8>::MBVHNode) + bytes_of(bvh.bvh8.bvh);
}

/// One of tinybvh's layouts over the triangles of a scene. It normalizes directions and knows no
/// t_min, so rays begin at their t_min and t is scaled back.
template <class Layout>
class TinyBvh : public TraversalAccelerator<TinyBvh<Layout>> {
 public:
  TinyBvh(const Scene& scene, bool high_quality, bool exact_t) : scene_(&scene), exact_t_(exact_t) {
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
      for (const glm::vec3& corner : adapters::corners(scene, i)) {
        vertices_.push_back({corner.x, corner.y, corner.z, 0.0F});
      }
    }
    const auto triangles = static_cast<std::uint32_t>(scene.triangles.size());
    if (triangles == 0) return;
    if (high_quality) {
      layout_.BuildHQ(vertices_.data(), triangles);
    } else {
      layout_.Build(vertices_.data(), triangles);
    }
  }

  template <class Counting>
  std::optional<Hit> find_closest(const Ray& ray, Counting&) const {
    if (vertices_.empty() || ray.t_min > ray.t_max) return std::nullopt;
    const float length = glm::length(ray.direction);
    tinybvh::Ray query = begun(ray, length);
    const float end = query.hit.t;
    layout_.Intersect(query);
    if (!(query.hit.t < end)) return std::nullopt;
    const float t = ray.t_min + query.hit.t / length;
    if (exact_t_) return adapters::with_exact_t(*scene_, ray, query.hit.prim, t);
    return Hit{t, scene_->triangles[query.hit.prim].primitive};
  }

  template <class Counting>
  bool find_any(const Ray& ray, Counting&) const {
    if (vertices_.empty() || ray.t_min > ray.t_max) return false;
    return layout_.IsOccluded(begun(ray, glm::length(ray.direction)));
  }

  Statistics statistics() const override {
    Statistics statistics;
    statistics.nodes = layout_.usedNodes;
    statistics.references = layout_.idxCount;
    statistics.bytes = bytes_of(layout_) + vertices_.capacity() * sizeof(tinybvh::bvhvec4);
    return statistics;
  }

 private:
  static tinybvh::Ray begun(const Ray& ray, float length) {
    const float reach = (ray.t_max - ray.t_min) * length;
    return {vec3(ray.origin + ray.direction * ray.t_min), vec3(ray.direction),
            reach < BVH_FAR ? reach : BVH_FAR};
  }

  const Scene* scene_;
  bool exact_t_;
  std::vector<tinybvh::bvhvec4> vertices_;  // tinybvh keeps pointers into it
  Layout layout_;
};

std::unique_ptr<Accelerator> build(const Scene& scene, const Parameters& parameters,
                                   const Workload&) {
  adapters::require_triangles_only(scene, "tinybvh");
  const std::string& layout = parameters.choice("layout");
  const bool high_quality = parameters.flag("hq");
  const bool exact_t = parameters.flag("exact_t");
  if (layout == "bvh2")
    return std::make_unique<TinyBvh<tinybvh::BVH>>(scene, high_quality, exact_t);
#ifdef BVH_USEAVX2
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) {
    throw InputError("tinybvh:layout=bvh8 needs AVX2 and FMA; take tinybvh:layout=bvh2");
  }
  return std::make_unique<TinyBvh<tinybvh::BVH8_CPU>>(scene, high_quality, exact_t);
#else
  throw InputError("this plug-in was built without AVX2 and FMA; take tinybvh:layout=bvh2");
#endif
}

}  // namespace

const Plugin beambench_plugin{
    .description = "Jacco Bikker's tinybvh", .fill = [](PluginContents& contents) {
      contents.structures.push_back(
          {"tinybvh",
           "Bikker's library of one header: a binned SAH hierarchy of two or eight children a node",
           Conformance::kTolerance,
           {choice_parameter("layout", "bvh8", {"bvh8", "bvh2"}, "children a node; bvh8: by AVX2"),
            flag_parameter("hq", false, "build with spatial splits"),
            adapters::exact_t_parameter()},
           build});
    }};
