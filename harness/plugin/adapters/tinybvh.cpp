// Jacco Bikker's tinybvh (https://github.com/jbikker/tinybvh, MIT) as a plug-in, with its layouts
// for CPUs.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#define NO_THREADED_BUILDS  // every contender builds on one thread
#define TINYBVH_IMPLEMENTATION
#include <glm/geometric.hpp>
#include <tiny_bvh.h>

#include "library_version.hpp"
#include "scene_triangles.hpp"

namespace {

using namespace beambench;
using namespace beambench::accel;
using namespace beambench::plugin;
using namespace beambench::scenes;

tinybvh::bvhvec3 vec3(const glm::vec3& v) { return {v.x, v.y, v.z}; }

/// Returns the bytes of a layout, including the layouts from which it was made: tinybvh does not
/// free them.
std::size_t bytes_of(const tinybvh::BVH& bvh) {
  return bvh.allocatedNodes * sizeof(tinybvh::BVH::BVHNode) +
         bvh.idxCount * (sizeof(std::uint32_t) + sizeof(tinybvh::BVHBase::Fragment));
}
template <int kChildren>
std::size_t bytes_of(const tinybvh::MBVH<kChildren>& wide) {
  return wide.allocatedNodes * sizeof(typename tinybvh::MBVH<kChildren>::MBVHNode) +
         bytes_of(wide.bvh);
}
std::size_t bytes_of(const tinybvh::BVH_SoA& soa) {
  return soa.allocatedNodes * sizeof(tinybvh::BVH_SoA::BVHNode) + bytes_of(soa.bvh);
}
std::size_t bytes_of(const tinybvh::BVH4_CPU& bvh) {
#if TINY_BVH_VERSION_MINOR < 5
  return bvh.allocatedNodes * sizeof(tinybvh::BVH4_CPU::BVHNode) + bytes_of(bvh.bvh4);
#else
  return bvh.allocatedBlocks * sizeof(tinybvh::BVH4_CPU::CacheLine) + bytes_of(bvh.bvh4);
#endif
}
std::size_t bytes_of(const tinybvh::BVH8_CPU& bvh) {
  return bvh.allocatedBlocks * sizeof(tinybvh::BVH8_CPU::CacheLine) + bytes_of(bvh.bvh8);
}

/// Returns the binary hierarchy from which a layout was made.
const tinybvh::BVH& binary(const tinybvh::BVH& bvh) { return bvh; }
const tinybvh::BVH& binary(const tinybvh::BVH_SoA& soa) { return soa.bvh; }
const tinybvh::BVH& binary(const tinybvh::BVH4_CPU& bvh) { return bvh.bvh4.bvh; }
const tinybvh::BVH& binary(const tinybvh::BVH8_CPU& bvh) { return bvh.bvh8.bvh; }

std::string stated_version() {
  return adapters::library_version("tinybvh " + std::to_string(TINY_BVH_VERSION_MAJOR) + "." +
                                   std::to_string(TINY_BVH_VERSION_MINOR) + "." +
                                   std::to_string(TINY_BVH_VERSION_SUB));
}

struct Options {
  bool spatial;
  std::uint32_t optimize;  ///< iterations
  bool normalize;
  bool exact_t;
};

/// One of tinybvh's layouts over the triangles of a scene. tinybvh does not support t_min, so each
/// ray's origin is moved to its t_min.
template <class Layout>
class TinyBvh : public TraversalAccelerator<TinyBvh<Layout>> {
 public:
  TinyBvh(const Scene& scene, const Options& options) : scene_(&scene), options_(options) {
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
      for (const glm::vec3& corner : adapters::corners(scene, i)) {
        vertices_.push_back({corner.x, corner.y, corner.z, 0.0F});
      }
    }
    const auto triangles = static_cast<std::uint32_t>(scene.triangles.size());
    if (triangles == 0) return;
    if (options.optimize > 0) {
      build_optimized(triangles);
    } else if (options.spatial) {
      layout_.BuildHQ(vertices_.data(), triangles);
    } else {
      build_binned(layout_, triangles);
    }
  }

  template <class Counting>
  std::optional<Hit> find_closest(const Ray& ray, Counting&) const {
    if (vertices_.empty() || ray.t_min > ray.t_max) return std::nullopt;
    const float unit = unit_of(ray);
    tinybvh::Ray query = converted(ray, unit);
    const float end = query.hit.t;
    layout_.Intersect(query);
    if (!(query.hit.t < end)) return std::nullopt;
    const float t = ray.t_min + query.hit.t / unit;
    if (options_.exact_t) return adapters::with_exact_t(*scene_, ray, query.hit.prim, t);
    return Hit{t, scene_->triangles[query.hit.prim].primitive};
  }

  template <class Counting>
  bool find_any(const Ray& ray, Counting&) const {
    if (vertices_.empty() || ray.t_min > ray.t_max) return false;
    return layout_.IsOccluded(converted(ray, unit_of(ray)));
  }

  Statistics statistics() const override {
    Statistics statistics;
    statistics.library_version = stated_version();
    if (vertices_.empty()) return statistics;
    statistics.nodes = used_nodes();
    statistics.references = binary(layout_).idxCount;
    statistics.bytes = bytes_of(layout_) + vertices_.capacity() * sizeof(tinybvh::bvhvec4);
    return statistics;
  }

 private:
  /// Builds a layout. The wider layouts choose the fastest builder themselves. BVH::Build is the
  /// reference builder, so BVH::BuildAVX is called where available; it makes the same tree.
  template <class Built>
  void build_binned(Built& built, std::uint32_t triangles) {
#ifdef BVH_USEAVX
    if constexpr (std::is_same_v<Built, tinybvh::BVH>) {
      built.BuildAVX(vertices_.data(), triangles);
      return;
    }
#endif
    built.Build(vertices_.data(), triangles);
  }

  /// Builds and optimizes a layout. The wider layouts' own `Optimize` is not used, because it loses
  /// triangles: these layouts join leaves, whose triangles must be neighbors. After subtrees have
  /// been moved, only `Compact` makes the triangles neighbors again.
  void build_optimized(std::uint32_t triangles) {
    auto& bvh = const_cast<tinybvh::BVH&>(binary(layout_));
    if (options_.spatial) {
      bvh.BuildHQ(vertices_.data(), triangles);
    } else {
      build_binned(bvh, triangles);
    }
    bvh.Optimize(options_.optimize, /*extreme=*/true);
    bvh.Compact();
    if constexpr (std::is_same_v<Layout, tinybvh::BVH_SoA>) layout_.ConvertFrom(layout_.bvh, false);
    if constexpr (std::is_same_v<Layout, tinybvh::BVH4_CPU>) layout_.ConvertFrom(layout_.bvh4);
    if constexpr (std::is_same_v<Layout, tinybvh::BVH8_CPU>) layout_.ConvertFrom(layout_.bvh8);
  }

  std::uint64_t used_nodes() const {
    if constexpr (std::is_same_v<Layout, tinybvh::BVH4_CPU>) return layout_.bvh4.usedNodes;
    if constexpr (std::is_same_v<Layout, tinybvh::BVH8_CPU>) return layout_.bvh8.usedNodes;
    return binary(layout_).usedNodes;
  }

  /// Returns the factor from beambench's t to tinybvh's: the direction's length if directions are
  /// normalized.
  float unit_of(const Ray& ray) const {
    return options_.normalize ? glm::length(ray.direction) : 1.0F;
  }

  tinybvh::Ray converted(const Ray& ray, float unit) const {
    const tinybvh::bvhvec3 origin = vec3(ray.origin + ray.direction * ray.t_min);
    const float reach = (ray.t_max - ray.t_min) * unit;
    const float far = options_.normalize ? BVH_FAR : kFarNotNormalized;
    const float t_max = reach < far ? reach : far;
    // Sets the members as tinybvh's ray constructor does, which always normalizes.
    tinybvh::Ray query;
    query.O = origin;
    query.D =
        options_.normalize ? tinybvh::tinybvh_normalize(vec3(ray.direction)) : vec3(ray.direction);
    query.rD = tinybvh::tinybvh_rcp(query.D);
    query.hit.t = t_max;
    return query;
  }

  /// Empty children are boxes at BVH_FAR, 1e30. A ray with a long direction would reach them at a
  /// smaller t, where there is no node. With this limit, rays with directions of length up to 1e10
  /// do not reach them.
  static constexpr float kFarNotNormalized = 1e20F;

  const Scene* scene_;
  Options options_;
  std::vector<tinybvh::bvhvec4> vertices_;  // tinybvh keeps pointers to it
  Layout layout_;
};

/// tinybvh's BVH_Double. The constructor of its rays normalizes directions in double; t is
/// converted back.
class TinyBvhDouble : public TraversalAccelerator<TinyBvhDouble> {
 public:
  TinyBvhDouble(const Scene& scene, bool exact_t) : scene_(&scene), exact_t_(exact_t) {
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
      for (const glm::vec3& corner : adapters::corners(scene, i)) {
        vertices_.emplace_back(corner.x, corner.y, corner.z);
      }
    }
    if (!vertices_.empty()) bvh_.Build(vertices_.data(), scene.triangles.size());
  }

  template <class Counting>
  std::optional<Hit> find_closest(const Ray& ray, Counting&) const {
    if (vertices_.empty() || ray.t_min > ray.t_max) return std::nullopt;
    tinybvh::RayEx query = converted(ray);
    const double end = query.hit.t;
    bvh_.Intersect(query);
    if (!(query.hit.t < end)) return std::nullopt;
    const auto t = static_cast<float>(ray.t_min + query.hit.t / unit_of(ray));
    const auto triangle = static_cast<std::size_t>(query.hit.prim);
    if (exact_t_) return adapters::with_exact_t(*scene_, ray, triangle, t);
    return Hit{t, scene_->triangles[triangle].primitive};
  }

  template <class Counting>
  bool find_any(const Ray& ray, Counting&) const {
    if (vertices_.empty() || ray.t_min > ray.t_max) return false;
    return bvh_.IsOccluded(converted(ray));
  }

  Statistics statistics() const override {
    Statistics statistics;
    statistics.library_version = stated_version();
    statistics.nodes = bvh_.usedNodes;
    statistics.references = bvh_.idxCount;
    statistics.bytes =
        bvh_.allocatedNodes * sizeof(tinybvh::BVH_Double::BVHNode) +
        bvh_.idxCount * (sizeof(std::uint64_t) + sizeof(tinybvh::BVH_Double::Fragment)) +
        vertices_.capacity() * sizeof(tinybvh::bvhdbl3);
    return statistics;
  }

 private:
  static double unit_of(const Ray& ray) { return glm::length(glm::dvec3(ray.direction)); }

  static tinybvh::RayEx converted(const Ray& ray) {
    const glm::dvec3 direction(ray.direction);
    const glm::dvec3 origin = glm::dvec3(ray.origin) + direction * double{ray.t_min};
    const double reach = (double{ray.t_max} - ray.t_min) * unit_of(ray);
    return {{origin.x, origin.y, origin.z},
            {direction.x, direction.y, direction.z},
            reach < BVH_DBL_FAR ? reach : BVH_DBL_FAR};
  }

  const Scene* scene_;
  bool exact_t_;
  std::vector<tinybvh::bvhdbl3> vertices_;  // tinybvh keeps a pointer to it
  tinybvh::BVH_Double bvh_;
};

std::unique_ptr<Accelerator> build(const Scene& scene, const Parameters& parameters,
                                   const Workload&) {
  adapters::require_triangles_only(scene, "tinybvh");
  const std::string& layout = parameters.choice("layout");
  const Options options{.spatial = parameters.choice("builder") == "spatial",
                        .optimize = static_cast<std::uint32_t>(parameters.integer("optimize")),
                        .normalize = parameters.flag("normalize"),
                        .exact_t = parameters.flag("exact_t")};
  if (layout == "double") {
    if (options.spatial || options.optimize > 0 || !options.normalize) {
      throw InputError(
          "tinybvh:layout=double has one builder and no optimizer, and normalizes; omit builder, "
          "optimize and normalize");
    }
    return std::make_unique<TinyBvhDouble>(scene, options.exact_t);
  }
#ifdef BVH_USEAVX2
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) {
    throw InputError("this plug-in was built for AVX2 and FMA, which this processor lacks");
  }
  if (layout == "bvh8") return std::make_unique<TinyBvh<tinybvh::BVH8_CPU>>(scene, options);
  if (layout == "bvh4") return std::make_unique<TinyBvh<tinybvh::BVH4_CPU>>(scene, options);
  if (layout == "soa") return std::make_unique<TinyBvh<tinybvh::BVH_SoA>>(scene, options);
#else
  if (layout != "bvh2") {
    throw InputError("this plug-in was built without AVX2 and FMA; use tinybvh:layout=bvh2");
  }
#endif
  return std::make_unique<TinyBvh<tinybvh::BVH>>(scene, options);
}

}  // namespace

const Plugin beambench_plugin{
    .description = "Jacco Bikker's tinybvh", .fill = [](PluginContents& contents) {
      contents.structures.push_back(
          {"tinybvh",
           "Bikker's single-header library: SAH hierarchies, two, four or eight children per node",
           Conformance::kTolerance,
           {choice_parameter("layout", "bvh8", {"bvh8", "bvh4", "soa", "bvh2", "double"},
                             "children a node: BVH8_CPU by AVX2, BVH4_CPU by SSE, BVH_SoA with two "
                             "by SSE, BVH with two, BVH_Double with two in double precision"),
            choice_parameter("builder", "binned", {"binned", "spatial"},
                             "spatial: with spatial splits (Stich and others 2009), its BuildHQ"),
            integer_parameter("optimize", 0, 0, 10000,
                              "optimizer iterations, which reinsert subtrees after the build"),
            flag_parameter(
                "normalize", true,
                "normalize directions, as its ray constructor does; t is converted back"),
            adapters::exact_t_parameter()},
           build,
           {.spheres = false, .cones = false}});
    }};
