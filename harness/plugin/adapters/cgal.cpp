// CGAL's AABB tree of triangles (https://www.cgal.org, GPL 3 or later) as a plug-in, with the
// kernel that its manual calls the fastest.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/version.h>

#include "scene_triangles.hpp"

namespace {

using namespace beambench;
using namespace beambench::accel;
using namespace beambench::plugin;
using namespace beambench::scenes;

using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;
using Vector = Kernel::Vector_3;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

template <class V>
Point point(const V& v) {
  return {v.x, v.y, v.z};
}

/// The tree. CGAL's rays are infinite: they begin at the point with t_min, and hits beyond t_max
/// are discarded.
class CgalTree : public TraversalAccelerator<CgalTree> {
 public:
  explicit CgalTree(const Scene& scene) : scene_(&scene) {
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
      const auto [a, b, c] = adapters::corners(scene, i);
      triangles_.emplace_back(point(a), point(b), point(c));
    }
    tree_.insert(triangles_.cbegin(), triangles_.cend());
    tree_.build();
  }

  template <class Counting>
  std::optional<Hit> find_closest(const Ray& ray, Counting&) const {
    if (ray.t_min > ray.t_max) return std::nullopt;
    const Kernel::Ray_3 query = converted(ray);
    const auto found = tree_.first_intersection(query);
    if (!found) return std::nullopt;
    const Vector way = query.to_vector();
    const auto t_of = [&](const Point& place) {
      const double t = ray.t_min + (place - query.source()) * way / way.squared_length();
      return std::max(static_cast<float>(t), ray.t_min);  // that point is rounded, too
    };
    const auto* place = boost::get<Point>(&found->first);
    const auto* line = boost::get<Kernel::Segment_3>(&found->first);  // in the triangle's plane
    const float t =
        place != nullptr ? t_of(*place) : std::min(t_of(line->source()), t_of(line->target()));
    if (t > ray.t_max) return std::nullopt;
    const auto triangle = static_cast<std::size_t>(found->second - triangles_.cbegin());
    return Hit{t, scene_->triangles[triangle].primitive};
  }

  template <class Counting>
  bool find_any(const Ray& ray, Counting&) const {
    if (ray.t_min > ray.t_max) return false;
    const Kernel::Ray_3 query = converted(ray);
    if (ray.t_max == kInfinity) return tree_.do_intersect(query);
    const Point end = query.source() + (double{ray.t_max} - ray.t_min) * query.to_vector();
    return tree_.do_intersect(Kernel::Segment_3(query.source(), end));
  }

  Statistics statistics() const override {
    Statistics statistics;
    statistics.library_version = "CGAL " CGAL_VERSION_STR;
    statistics.references = tree_.size();
    return statistics;
  }

 private:
  static Kernel::Ray_3 converted(const Ray& ray) {
    const glm::dvec3 direction(ray.direction);
    const glm::dvec3 origin = glm::dvec3(ray.origin) + direction * double{ray.t_min};
    return {point(origin), Vector(direction.x, direction.y, direction.z)};
  }

  const Scene* scene_;
  Triangles triangles_;
  Tree tree_;
};

std::unique_ptr<Accelerator> build(const Scene& scene, const Parameters&, const Workload&) {
  adapters::require_triangles_only(scene, "cgal");
  return std::make_unique<CgalTree>(scene);
}

}  // namespace

const Plugin beambench_plugin{
    .description = "CGAL's AABB tree", .fill = [](PluginContents& contents) {
      contents.structures.push_back(
          {"cgal",
           "CGAL's AABB tree of triangles, Simple_cartesian<double>, single rays",
           Conformance::kTolerance,
           {},
           build,
           {.spheres = false, .cones = false}});
    }};
