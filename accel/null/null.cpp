// A structure that returns only misses, so that its measurements show the harness's own share.

#include "accel/core/instruction_set.hpp"
#include "accel/core/registry.hpp"
#include "accel/core/threads.hpp"
#include "accel/core/traversal_accelerator.hpp"
#include "accel/embree/image_tracers.hpp"
#include "accel/embree/list_tracers.hpp"

namespace beambench::accel::null {

namespace {

/// Generates or reads rays one by one: the harness's share for structures that trace an image by
/// `PrimaryRays::ray`, or a list.
class Null : public TraversalAccelerator<Null> {
 public:
  Statistics statistics() const override { return {}; }

  template <class Counting>
  std::optional<Hit> find_closest(const Ray& ray, Counting&) const {
    use(ray);
    return std::nullopt;
  }
  template <class Counting>
  bool find_any(const Ray& ray, Counting&) const {
    use(ray);
    return false;
  }

 private:
  /// Makes the compiler assume that the ray is used, so that generating it stays part of the
  /// overhead.
  static void use(const Ray& ray) { asm volatile("" : : "g"(&ray) : "memory"); }
};

/// Generates the packets of images and packs lists by SIMD: the harness's minimum share for
/// `embree` in any mode.
class SimdNull : public Null {
 public:
  explicit SimdNull(std::int64_t targets)
      : images_(&embree::image_tracers(targets)), lists_(&embree::list_tracers(targets)) {}

  void closest_hits(const RaySource& rays, const HitSpan& hits,
                    const QueryContext& context) const override {
    if (const PrimaryRays* image = rays.image()) return make_rays(*image, hits, context.threads);
    if (const RayBatch* batch = rays.batch()) {
      return lists_->untraced_closest(owners_, batch->rays, hits);
    }
    Null::closest_hits(rays, hits, context);
  }
  void any_hits(const RaySource& rays, std::span<std::uint8_t> hits,
                const QueryContext& context) const override {
    if (const RayBatch* batch = rays.batch()) return lists_->untraced_any(batch->rays, hits);
    Null::any_hits(rays, hits, context);
  }

  Statistics statistics() const override {
    Statistics statistics;
    statistics.image_rays = ImageRays::kSimd;
    statistics.instruction_set = best_simd_target();
    return statistics;
  }

 private:
  void make_rays(const PrimaryRays& image, const HitSpan& hits, int threads) const {
    if (thread_count(threads) == 1) {
      return images_->untraced(owners_, image, {0, image.height()}, hits);
    }
    on_threads(threads, [&] {
      share_rows(embree::tile_rows(image), [&](int begin, int end) {
        images_->untraced(owners_, image, embree::band_of(image, begin, end), hits);
      });
    });
  }

  const embree::ImageTracers* images_;
  const embree::ListTracers* lists_;
  embree::OwnerTable owners_;  ///< empty
};

}  // namespace

void register_null(Registry& registry) {
  registry.add(
      {"null",
       "returns a miss at once: measures the harness's own share",
       Conformance::kBaseline,
       {choice_parameter("rays", "single", {"single", "simd"},
                         "how rays are generated or read and hits are stored: one by one, as "
                         "for most structures, or by SIMD, as for embree")},
       [](const scenes::Scene&, const Parameters& parameters,
          const Workload&) -> std::unique_ptr<Accelerator> {
         if (parameters.choice("rays") == "single") return std::make_unique<Null>();
         return std::make_unique<SimdNull>(targets_of("best"));
       }});
}

}  // namespace beambench::accel::null
