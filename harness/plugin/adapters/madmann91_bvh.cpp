// Arsène Pérard-Gayot's bvh (https://github.com/madmann91/bvh, MIT), version 2, as a plug-in.

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <bvh/v2/bvh.h>
#include <bvh/v2/default_builder.h>
#include <bvh/v2/node.h>
#include <bvh/v2/ray.h>
#include <bvh/v2/stack.h>
#include <bvh/v2/tri.h>
#include <bvh/v2/vec.h>

#include "library_version.hpp"
#include "madmann91_hit.hpp"
#include "scene_triangles.hpp"

namespace {

using namespace beambench;
using namespace beambench::accel;
using namespace beambench::plugin;
using namespace beambench::scenes;

using Vec3 = ::bvh::v2::Vec<float, 3>;
using Box3 = ::bvh::v2::BBox<float, 3>;
using Node = ::bvh::v2::Node<float, 3>;
using Builder = ::bvh::v2::DefaultBuilder<Node>;

Vec3 vec3(const glm::vec3& v) { return {v.x, v.y, v.z}; }

::bvh::v2::Bvh<Node> build_bvh(const std::vector<::bvh::v2::Tri<float, 3>>& triangles,
                               const std::string& quality) {
  std::vector<Box3> boxes;
  std::vector<Vec3> centers;
  for (const auto& triangle : triangles) {
    boxes.push_back(triangle.get_bbox());
    centers.push_back(triangle.get_center());
  }
  Builder::Config config;
  config.quality = quality == "high"     ? Builder::Quality::High
                   : quality == "medium" ? Builder::Quality::Medium
                                         : Builder::Quality::Low;
  return Builder::build(boxes, centers, config);  // on this thread
}

/// The library's hierarchy and its triangles, in the order of the leaves.
template <bool kRobust>
class MadmannBvh : public TraversalAccelerator<MadmannBvh<kRobust>> {
 public:
  MadmannBvh(const Scene& scene, const std::string& quality, bool exact_t)
      : scene_(&scene), exact_t_(exact_t) {
    std::vector<::bvh::v2::Tri<float, 3>> triangles;
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
      const auto [a, b, c] = adapters::corners(scene, i);
      triangles.emplace_back(vec3(a), vec3(b), vec3(c));
    }
    if (triangles.empty()) return;
    bvh_ = build_bvh(triangles, quality);
    for (const std::size_t id : bvh_.prim_ids) triangles_.emplace_back(triangles[id]);
  }

  template <class Counting>
  std::optional<Hit> find_closest(const Ray& ray, Counting& counting) const {
    auto query = converted(ray);
    const auto found = visit<false>(query, counting);
    if (!found) return std::nullopt;
    if (exact_t_) return adapters::with_exact_t(*scene_, ray, *found, query.tmax);
    return Hit{query.tmax, scene_->triangles[*found].primitive};
  }

  template <class Counting>
  bool find_any(const Ray& ray, Counting& counting) const {
    auto query = converted(ray);
    return visit<true>(query, counting).has_value();
  }

  Statistics statistics() const override {
    Statistics statistics;
    statistics.nodes = bvh_.nodes.size();
    statistics.leaves = (bvh_.nodes.size() + 1) / 2;
    statistics.references = bvh_.prim_ids.size();
    statistics.bytes = bvh_.nodes.capacity() * sizeof(Node) +
                       bvh_.prim_ids.capacity() * sizeof(std::size_t) +
                       triangles_.capacity() * sizeof(triangles_[0]);
    // Its headers do not state a version.
    statistics.library_version = adapters::library_version("madmann91/bvh 2");
    return statistics;
  }

 private:
  using TheirRay = ::bvh::v2::Ray<float, 3>;
  using Index = typename ::bvh::v2::Bvh<Node>::Index;

  static TheirRay converted(const Ray& ray) {
    return {vec3(ray.origin), vec3(ray.direction), ray.t_min, ray.t_max};
  }

  /// Returns the index of the hit triangle in the scene; `ray.tmax` is the t of the hit.
  template <bool kAny, class Counting>
  std::optional<std::size_t> visit(TheirRay& ray, Counting& counting) const {
    if (triangles_.empty()) return std::nullopt;
    std::optional<std::size_t> found;
    ::bvh::v2::SmallStack<Index, 64> stack;
    bvh_.template intersect<kAny, kRobust>(
        ray, bvh_.get_root().index, stack,
        [&](std::size_t begin, std::size_t end) {
          counting.add(Counter::kTraversalSteps);
          counting.add(Counter::kLeaves);
          counting.add_tests(PrimitiveKind::kPolygon, end - begin);
          for (std::size_t i = begin; i < end; ++i) {
            if (const auto hit = triangles_[i].intersect(ray)) {
              adapters::end_at(ray, *hit);
              found = bvh_.prim_ids[i];
            }
          }
          return found.has_value();
        },
        [&](const Node&, const Node&) {
          counting.add(Counter::kTraversalSteps);
          counting.add(Counter::kBoxTests, 2);
        });
    return found;
  }

  const Scene* scene_;
  bool exact_t_;
  ::bvh::v2::Bvh<Node> bvh_;
  std::vector<::bvh::v2::PrecomputedTri<float>> triangles_;
};

std::unique_ptr<Accelerator> build(const Scene& scene, const Parameters& parameters,
                                   const Workload&) {
  adapters::require_triangles_only(scene, "madmann91-bvh");
  const std::string& quality = parameters.choice("quality");
  const bool exact_t = parameters.flag("exact_t");
  if (parameters.flag("robust")) return std::make_unique<MadmannBvh<true>>(scene, quality, exact_t);
  return std::make_unique<MadmannBvh<false>>(scene, quality, exact_t);
}

}  // namespace

const Plugin beambench_plugin{
    .description = "Arsène Pérard-Gayot's bvh, version 2", .fill = [](PluginContents& contents) {
      contents.structures.push_back(
          {"madmann91-bvh",
           "Pérard-Gayot's header-only library: binary SAH hierarchies, single rays",
           Conformance::kTolerance,
           {choice_parameter("quality", "high", {"high", "medium", "low"},
                             "effort spent on building the hierarchy"),
            flag_parameter("robust", true, "use the box test that loses no hits (Ize 2013)"),
            adapters::exact_t_parameter()},
           build,
           {.spheres = false, .cones = false}});
    }};
