// A structure that answers nothing: what remains of a measurement is the harness's own overhead.

#include "accel/registry.hpp"
#include "accel/traversal_accelerator.hpp"

namespace beambench {

namespace {

class Null : public TraversalAccelerator<Null> {
 public:
  Statistics statistics() const override { return {}; }

  template <class Counting>
  std::optional<Hit> find_closest(const Ray& ray, Counting&) const {
    take(ray);
    return std::nullopt;
  }
  template <class Counting>
  bool find_any(const Ray& ray, Counting&) const {
    take(ray);
    return false;
  }

 private:
  /// Tells the compiler that the ray is looked at: making it is part of the overhead.
  static void take(const Ray& ray) { asm volatile("" : : "g"(&ray) : "memory"); }
};

}  // namespace

void register_null(Registry& registry) {
  registry.add(
      {"null",
       "returns a miss at once: measures the harness's own overhead",
       Conformance::kBaseline,
       {},
       [](const Scene&, const Parameters&, const Workload&) { return std::make_unique<Null>(); }});
}

}  // namespace beambench
