#include "accel/exhaustive/exhaustive.hpp"

#include "accel/core/registry.hpp"

namespace beambench::accel::exhaustive {

void register_exhaustive(Registry& registry) {
  registry.add({"exhaustive",
                "tests every primitive against every ray: the definition of the correct hit",
                Conformance::kBitExact,
                {},
                [](const scenes::Scene& scene, const Parameters&, const Workload&) {
                  return std::make_unique<Exhaustive>(scene);
                }});
}

}  // namespace beambench::accel::exhaustive
