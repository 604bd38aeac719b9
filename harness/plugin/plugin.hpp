#pragma once
// Structures and scenes of your own, in a shared object that the program loads: --plugin FILE.
//
// A plug-in includes this header, which brings the contract of a structure and what it is made of,
// and defines one object at global scope:
//
//     const beambench::Plugin beambench_plugin{
//         .description = "My structures",
//         .fill = [](beambench::PluginContents& contents) {
//           contents.structures.push_back({"mine", "what it is, in a sentence",
//                                          beambench::Conformance::kBitExact, {},
//                                          [](const beambench::Scene& scene, const auto&,
//                                             const auto&) {
//                                            return std::make_unique<Mine>(scene);
//                                          }});
//         }};
//
// `beambench_add_plugin(mine mine.cpp)` of the CMake package builds it. A whole one to start from
// is tests/plugin/template.

#include <vector>

#include "accel/bvh/padded_bounds.hpp"
#include "accel/bvh/slab_ray.hpp"
#include "accel/intersect.hpp"
#include "accel/overlap.hpp"
#include "accel/registry.hpp"
#include "accel/tolerance.hpp"
#include "accel/traversal_accelerator.hpp"
#include "harness/plugin/plugin_stamp.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/error.hpp"
#include "scenes/portable_math.hpp"
#include "scenes/random.hpp"
#include "scenes/scene_builder.hpp"

#if defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__
#error "a ray-primitive test answers NaN for a miss: leave out -ffast-math and -ffinite-math-only"
#endif

namespace beambench {

/// What a plug-in brings. Names must be free: letters, digits, '-' and '_', a letter first.
struct PluginContents {
  std::vector<StructureInfo> structures;
  std::vector<SceneInfo> scenes;
  std::vector<SceneReader> readers;
};

/// A plug-in's way in.
struct Plugin {
  PluginStamp stamp = kPluginStamp;  ///< first, to be read before all else
  const char* description;           ///< one sentence; `beambench list` prints it
  /// Called once, when the program has found that the stamp is its own. Whatever it throws refuses
  /// the plug-in.
  void (*fill)(PluginContents& contents);
};

}  // namespace beambench

/// Defined by the plug-in.
extern "C" __attribute__((visibility("default"))) const beambench::Plugin beambench_plugin;
