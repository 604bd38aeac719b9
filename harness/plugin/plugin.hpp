#pragma once
// Structures and scenes of your own, in a shared object that the program loads: --plugin FILE.
//
// A plug-in includes this header, which declares the contract of a structure and its parts, and
// defines one object at global scope:
//
//     const beambench::plugin::Plugin beambench_plugin{
//         .description = "My structures",
//         .fill = [](beambench::plugin::PluginContents& contents) {
//           contents.structures.push_back({"mine", "what it is, in a sentence",
//                                          beambench::accel::Conformance::kBitExact, {},
//                                          [](const beambench::scenes::Scene& scene, const auto&,
//                                             const auto&) {
//                                            return std::make_unique<Mine>(scene);
//                                          }});
//         }};
//
// `beambench_add_plugin(mine mine.cpp)` of the CMake package builds it. Start from the complete
// example in tests/plugin/template.

#include <vector>

#include "accel/core/forwarding_accelerator.hpp"
#include "accel/core/intersect.hpp"
#include "accel/core/overlap.hpp"
#include "accel/core/padded_bounds.hpp"
#include "accel/core/registry.hpp"
#include "accel/core/slab_ray.hpp"
#include "accel/core/tolerance.hpp"
#include "accel/core/traversal_accelerator.hpp"
#include "harness/plugin/plugin_stamp.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/portable_math.hpp"
#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"

#if defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__
#error "a ray-primitive test returns NaN for a miss: leave out -ffast-math and -ffinite-math-only"
#endif

namespace beambench::plugin {

/// The contents of a plug-in. Names must not be in use and consist of letters, digits, '-' and '_',
/// with a letter first.
struct PluginContents {
  std::vector<accel::StructureInfo> structures;
  std::vector<scenes::SceneInfo> scenes;
  std::vector<scenes::SceneReader> readers;
};

/// The entry point of a plug-in.
struct Plugin {
  PluginStamp stamp = kPluginStamp;  ///< first, so that it is read before everything else
  const char* description;           ///< one sentence; `beambench list` prints it
  /// Called once, after the stamp has been found to match. If it throws, the plug-in is refused.
  void (*fill)(PluginContents& contents);
};

}  // namespace beambench::plugin

/// Defined by the plug-in.
extern "C" __attribute__((visibility("default"))) const beambench::plugin::Plugin beambench_plugin;
