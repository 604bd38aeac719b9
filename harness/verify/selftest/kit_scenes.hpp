#pragma once
// The scenes and rays of the conformance kit, by family.

#include <functional>
#include <string>

#include "harness/verify/selftest/selftest.hpp"
#include "harness/verify/selftest/subject.hpp"
#include "harness/verify/selftest/test_scenes.hpp"

namespace beambench::verify {

/// One scene of the kit.
struct KitScene {
  std::string family;
  /// The tolerance that a library computing in float can be expected to keep, in words.
  std::string tolerance;
  SceneWithRays made;
  /// Whether the rays begin inside a closed surface, so that each must hit, whatever the tolerance.
  bool closed = false;
};

/// The family of rays whose interval is not [0, infinity], which many libraries do not support.
/// They come from the scenes of the other families.
inline constexpr const char* kIntervalFamily = "t interval";

/// Calls `visit` for each scene, which has at least one ray; the same effort makes the same scenes
/// everywhere. Scenes that a family cannot make of these kinds of primitives are left out.
void for_each_kit_scene(const SelftestEffort& effort, PrimitiveKinds kinds,
                        const std::function<void(KitScene)>& visit);

}  // namespace beambench::verify
