#include "accel/octree/samet.hpp"

#include "accel/registry.hpp"

namespace beambench {

void register_octree(Registry& registry) {
  registry.add({"samet",
                "the octree of the thesis with Samet's 1989 traversal: explicit exit point, "
                "neighbours found over the nearest common ancestor",
                Conformance::kBitExact, OctreeOptions::parameters(),
                [](const Scene& scene, const Parameters& parameters) {
                  return std::make_unique<Samet>(scene, OctreeOptions::from(parameters));
                }});
}

}  // namespace beambench
