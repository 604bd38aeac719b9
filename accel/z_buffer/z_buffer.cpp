// A rasterizer without a hierarchy.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>

#include <glm/geometric.hpp>

#include "accel/core/image_accelerator.hpp"
#include "accel/core/intersect.hpp"
#include "accel/core/registry.hpp"
#include "accel/core/threads.hpp"
#include "accel/core/tolerance.hpp"
#include "accel/z_buffer/screen.hpp"

namespace beambench::accel::z_buffer {
namespace {

constexpr const char* kName = "z-buffer";

/// A factor that is below 1 by more than the rounding errors of t in float and of a
/// `TriangleOnScreen`'s depth in double.
constexpr double kNearly = 1.0 - 0x1p-20;

/// The edge functions and the depth of a triangle.
struct TriangleOnScreen {
  std::array<PixelLine, 3> edges;  ///< not negative in the triangle
  PixelLine inverse_t;             ///< at least 1 / view depth of its plane
  PixelBox box;

  bool may_hit(double px, double py, float nearest) const {
    return edges[0].at(px, py) >= 0.0 && edges[1].at(px, py) >= 0.0 && edges[2].at(px, py) >= 0.0 &&
           inverse_t.at(px, py) * nearest >= kNearly;
  }
};

/// A box on the screen; every sample is tested at which the box is near enough.
struct AnythingOnScreen {
  PixelBox box;

  bool may_hit(double, double, float nearest) const { return nearest >= box.nearest * kNearly; }
};

/// Rasterizes primitives into the rows [begin, end) of an image.
template <class Counting>
class Rasterizer {
 public:
  Rasterizer(const scenes::Scene& scene, const PrimaryRays& rays, const HitSpan& hits, int begin,
             int end, Counting& counting)
      : scene_(&scene),
        rays_(&rays),
        eye_(rays.eye()),
        screen_(rays),
        hits_(hits),
        begin_(begin),
        end_(end),
        counting_(&counting) {}

  void operator()() {
    const std::size_t from = hits_.index(0, begin_, 0);
    const std::size_t count = hits_.index(0, end_, 0) - from;
    std::fill_n(hits_.t() + from, count, kInfinity);
    std::fill_n(hits_.primitive() + from, count, scenes::kNoPrimitive);
    for (scenes::PrimitiveId id = 0; id < scene_->primitives.size(); ++id) draw(id);
  }

 private:
  void draw(scenes::PrimitiveId id) {
    const std::uint32_t index = scene_->primitives[id].index;
    switch (scene_->primitives[id].kind) {
      case scenes::PrimitiveKind::kSphere: {
        const scenes::Sphere& sphere = scene_->spheres[index];
        return draw_hull<1>(id, {Ball{from_eye(sphere.center), sphere.radius}},
                            [&](const CanonicalRay& ray) { return intersect_sphere(ray, sphere); });
      }
      case scenes::PrimitiveKind::kCone: {
        const scenes::Cone& cone = scene_->cones[index];
        return draw_hull<2>(id,
                            {Ball{from_eye(cone.base), cone.base_radius},
                             Ball{from_eye(cone.apex), cone.apex_radius}},
                            [&](const CanonicalRay& ray) { return intersect_cone(ray, cone); });
      }
      case scenes::PrimitiveKind::kPolygon: {
        const scenes::Polygon& polygon = scene_->polygons[index];
        for (std::uint32_t i = 0; i < polygon.triangle_count; ++i) {
          draw_triangle(id, scene_->triangles[polygon.first_triangle + i].vertex);
        }
      }
    }
  }

  glm::dvec3 from_eye(const glm::vec3& point) const { return glm::dvec3(point) - eye_; }

  /// Draws a primitive in the convex hull of balls: all samples of its box are tested.
  template <std::size_t kBalls, class Test>
  void draw_hull(scenes::PrimitiveId id, std::array<Ball, kBalls> hull, Test test) {
    double reach = 0.0;
    for (const Ball& ball : hull) reach = std::max(reach, glm::length(ball.center) + ball.radius);
    for (Ball& ball : hull) ball.radius += beside(reach);
    fill(id, AnythingOnScreen{screen_.box_of(hull)}, test);
  }

  void draw_triangle(scenes::PrimitiveId id, const std::array<std::uint32_t, 3>& vertex) {
    const glm::vec3& a = scene_->vertices[vertex[0]];
    const glm::vec3& b = scene_->vertices[vertex[1]];
    const glm::vec3& c = scene_->vertices[vertex[2]];
    const std::array corners{from_eye(a), from_eye(b), from_eye(c)};
    const auto test = [&](const CanonicalRay& ray) { return intersect_triangle(ray, a, b, c); };

    const auto squared = [](const glm::dvec3& v) { return glm::dot(v, v); };
    const double reach_squared =
        std::max({squared(corners[0]), squared(corners[1]), squared(corners[2])});
    const double reach = std::sqrt(reach_squared);
    const glm::dvec3 side = corners[1] - corners[0];
    const glm::dvec3 other = corners[2] - corners[0];
    const glm::dvec3 normal = glm::cross(side, other);
    const double volume = glm::dot(normal, corners[0]);
    // The error in double is at most 2^-49 * size for the normal and 2^-49 * size * reach for the
    // volume.
    const double size = std::sqrt(squared(side) * squared(other));
    // The eye is in the triangle's plane, or so close to it that rounding matters.
    if (!(std::abs(volume) > 0x1p-24 * size * reach * screen_.longest())) {
      return draw_hull<3>(id, {Ball{corners[0], 0.0}, Ball{corners[1], 0.0}, Ball{corners[2], 0.0}},
                          test);
    }

    TriangleOnScreen image;
    const double length = glm::length(normal);
    // No ray of the image meets the plane nearer than this view depth, which is halved below as a
    // margin for rounding.
    const double depth = std::abs(volume) / (length * screen_.longest());
    image.box = box_beyond(0.5 * depth, corners, beside(reach));
    if (image.box.empty()) return;
    const double inward = volume > 0.0 ? 1.0 : -1.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec3 edge = inward * glm::cross(corners[i], corners[(i + 1) % 3]);
      const double loss = 0x1p-46 * reach_squared * screen_.longest();
      image.edges[i] = screen_.product(edge, screen_.rounding() * glm::length(edge) + loss);
    }
    const double slack = screen_.rounding() * length + 0x1p-46 * size * screen_.longest();
    image.inverse_t = screen_.product(normal / volume, slack / std::abs(volume));
    fill(id, image, test);
  }

  /// Returns how far from a primitive a hit may lie (tolerance.hpp), with a margin, given the
  /// primitive's reach from the eye.
  static double beside(double reach) { return 4.0 * kHitSlack * reach; }

  /// Returns the box of the part of a triangle at view depths of at least `near` (by Sutherland and
  /// Hodgman's clipping against one plane), including hits within `slack` of the triangle.
  PixelBox box_beyond(double near, const std::array<glm::dvec3, 3>& corners, double slack) const {
    std::array<Ball, 4> hull;
    std::size_t count = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec3& from = corners[i];
      const glm::dvec3& to = corners[(i + 1) % 3];
      const double before = screen_.depth(from) - near;
      const double after = screen_.depth(to) - near;
      if (before >= 0.0) hull[count++] = {from, slack};
      if ((before >= 0.0) != (after >= 0.0)) {
        hull[count++] = {from + (to - from) * (before / (before - after)), slack};
      }
    }
    return screen_.box_of({hull.data(), count});
  }

  /// Runs the canonical test for all samples in the image's box that the image does not reject.
  template <class OnScreen, class Test>
  void fill(scenes::PrimitiveId id, const OnScreen& image, Test test) {
    const int last = std::min(image.box.last[1], end_ - 1);
    for (int y = std::max(image.box.first[1], begin_); y <= last; ++y) {
      for (int sample = 0; sample < rays_->samples(); ++sample) {
        const glm::dvec2& offset = rays_->offsets()[static_cast<std::size_t>(sample)];
        for (int x = image.box.first[0]; x <= image.box.last[0]; ++x) {
          const std::size_t index = hits_.index(x, y, sample);
          if (!image.may_hit(x + offset.x, y + offset.y, hits_.t()[index])) continue;
          counting_->add_tests(scene_->primitives[id].kind);
          ClosestHit closest(rays_->ray(x, y, sample));
          closest.keep(hits_.t()[index], hits_.primitive()[index]);
          closest.keep(test(closest.ray), id);
          hits_.set(index, closest.result());
        }
      }
    }
  }

  const scenes::Scene* scene_;
  const PrimaryRays* rays_;
  glm::dvec3 eye_;
  Screen screen_;
  HitSpan hits_;
  int begin_;
  int end_;
  Counting* counting_;
};

/// The textbook rasterizer: each primitive is projected, the pixels of its box on the screen are
/// tested by edge functions (Pineda, "A parallel algorithm for polygon rasterization", SIGGRAPH
/// 1988), and a buffer keeps the nearest hit of each sample (Catmull, "A subdivision algorithm for
/// computer display of curved surfaces", 1974). Nothing is built, and it traces only images.
///
/// Edge functions and depths only reject. Samples that pass are confirmed by the canonical test of
/// their ray, so hits equal those of `exhaustive`.
class ZBuffer : public ImageAccelerator {
 public:
  explicit ZBuffer(const scenes::Scene& scene) : ImageAccelerator(kName), scene_(&scene) {}

  void closest_hits(const RaySource& rays, const HitSpan& hits,
                    const QueryContext& context) const override {
    const PrimaryRays& image = image_of(rays);
    // Each band projects all primitives, so there are only as many bands as threads.
    const int bands = thread_count(context.threads);
    const auto first_row = [&](int band) { return image.height() * band / bands; };
    for_rows(context, bands, [&](int begin, int end, auto& counting) {
      Rasterizer(*scene_, image, hits, first_row(begin), first_row(end), counting)();
    });
  }
  /// Returns the statistics. Samples that no primitive covers do not become rays.
  Statistics statistics() const override {
    Statistics statistics;
    statistics.image_rays = ImageRays::kOwn;
    return statistics;
  }
  /// Replaces the scene. Nothing is built, so nothing must be updated.
  bool update(const scenes::Scene& scene) override {
    scene_ = &scene;
    return true;
  }

 private:
  const scenes::Scene* scene_;
};

}  // namespace

void register_z_buffer(Registry& registry) {
  registry.add({kName,
                "a rasterizer without a hierarchy: edge functions (Pineda 1988) over each "
                "primitive's box on the screen, and a z-buffer (Catmull 1974); images only",
                Conformance::kBitExact,
                {},
                [](const scenes::Scene& scene, const Parameters&, const Workload&) {
                  return std::make_unique<ZBuffer>(scene);
                },
                {.single_rays = false, .batches = false}});
}

}  // namespace beambench::accel::z_buffer
