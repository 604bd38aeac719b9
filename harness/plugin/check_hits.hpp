#pragma once
// Hits of an image that no differ has seen, looked over before something is made of them.

#include "accel/hit_buffer.hpp"
#include "accel/registry.hpp"
#include "scenes/scene.hpp"

namespace beambench {

/// Throws PluginError when a hit of the structure cannot be: its primitive is none of the scene's,
/// or its t is no number from 0 on.
void check_hits(const HitBuffer& hits, const Scene& scene, const StructureInfo& structure);

}  // namespace beambench
