#pragma once
// Exhaustive search: the definition of the correct hit.

#include "accel/core/intersect.hpp"
#include "accel/core/traversal_accelerator.hpp"

namespace beambench::accel::exhaustive {

/// Tests every primitive against every ray. Every classic structure must return the same hits, bit
/// for bit.
class Exhaustive : public TraversalAccelerator<Exhaustive> {
 public:
  explicit Exhaustive(const scenes::Scene& scene) : scene_(&scene) {}

  Statistics statistics() const override { return {}; }
  /// Nothing is built, so there is nothing to update.
  bool update(const scenes::Scene& scene) override {
    scene_ = &scene;
    return true;
  }

  template <class Counting>
  std::optional<Hit> find_closest(const Ray& ray, Counting& counting) const {
    ClosestHit closest(ray);
    counting.enter([&] { return TraceStep{.t_enter = ray.t_min, .t_exit = ray.t_max}; });
    for (scenes::PrimitiveId id = 0; id < scene_->primitives.size(); ++id) {
      counting.add_tests(scene_->primitives[id].kind);
      counting.tested(id, closest.test(*scene_, id));
    }
    return closest.result();
  }

  template <class Counting>
  bool find_any(const Ray& ray, Counting& counting) const {
    const CanonicalRay canonical(ray);
    for (scenes::PrimitiveId id = 0; id < scene_->primitives.size(); ++id) {
      counting.add_tests(scene_->primitives[id].kind);
      if (is_hit(intersect(canonical, *scene_, id))) return true;
    }
    return false;
  }

 private:
  const scenes::Scene* scene_;
};

}  // namespace beambench::accel::exhaustive
