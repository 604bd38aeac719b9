#include "harness/plugin/check_hits.hpp"

#include <fmt/format.h>

#include "scenes/plugin_error.hpp"

namespace beambench {

void check_hits(const HitBuffer& hits, const Scene& scene, const StructureInfo& structure) {
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const auto hit = hits.get(i);
    if (!hit || (hit->primitive < scene.primitives.size() && hit->t >= 0.0F)) continue;
    throw PluginError(fmt::format(
        "the plug-in {} answers nonsense: '{}' found primitive {} of {} at t = {}",
        structure.origin, structure.name, hit->primitive, scene.primitives.size(), hit->t));
  }
}

}  // namespace beambench
