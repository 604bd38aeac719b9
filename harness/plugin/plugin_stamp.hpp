#pragma once
// Properties that must be equal in a plug-in and in the program, compared before any call.

#include <array>
#include <cstddef>
#include <cstdint>
#include <version>

#include "accel/core/registry.hpp"
#include "accel/core/traversal_accelerator.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene.hpp"

namespace beambench::plugin {

/// Incremented whenever an installed header changes in such a way that a plug-in built with the old
/// header would fail: a virtual function, a type, the meaning of a call. load_plugin.cpp lists the
/// changes of each version.
inline constexpr std::uint32_t kPluginInterface = 9;

/// Identifies the build of a plug-in. The position of the first two members never changes.
struct PluginStamp {
  std::uint64_t magic;
  std::uint32_t interface_version;
  bool optimized;
  std::uint64_t layout;      ///< fingerprint of the types that both sides use
  const char* library;       ///< the C++ library and its binary interface
  const char* compiler;      ///< may differ from the program's
  const char* instructions;  ///< the instruction set for which it was compiled
};

namespace plugin_stamp {

/// Hashes with FNV-1a the sizes and alignments of all types that both sides use. These change with
/// the project's headers, and with macros that change GLM or the C++ library.
template <class... Types>
constexpr std::uint64_t layout_of() {
  std::uint64_t hash = 0xCBF29CE484222325U;
  for (const std::size_t number : {sizeof(Types)..., alignof(Types)...}) {
    hash = (hash ^ number) * 0x100000001B3U;
  }
  return hash;
}

inline constexpr std::uint64_t kMagic = 0x636E65626D616562U;  // "beambenc" in memory
inline constexpr std::uint64_t kLayout = plugin_stamp::layout_of<
    glm::vec3, glm::dvec3, scenes::Scene, scenes::Camera, scenes::Surface, scenes::Light,
    scenes::Primitive, scenes::Sphere, scenes::Cone, scenes::Polygon, scenes::Triangle,
    scenes::Bounds, accel::Ray, accel::Pencil, accel::RayBatch, accel::RaySource, accel::Hit,
    accel::HitBuffer, accel::HitSpan, accel::QueryContext, accel::Inspector, accel::Support,
    accel::SampleSteps, accel::BeamPassage, accel::NodeFacts, accel::PrimaryRays,
    accel::WorkCounters, accel::Statistics, accel::TraceStep, accel::BeamOutline, accel::BeamPlace,
    accel::Box, accel::Accelerator, accel::Workload, Parameters, ParameterInfo,
    accel::StructureInfo, scenes::SceneInfo, scenes::SceneReader>();

#if defined(_LIBCPP_VERSION)
inline constexpr const char* kLibrary = "libc++";
#elif defined(_GLIBCXX_DEBUG)
inline constexpr const char* kLibrary = "libstdc++ in debug mode";
#elif defined(_GLIBCXX_USE_CXX11_ABI) && !_GLIBCXX_USE_CXX11_ABI
inline constexpr const char* kLibrary = "libstdc++ with the strings of before C++11";
#else
inline constexpr const char* kLibrary = "libstdc++";
#endif

#if defined(__clang__)
inline constexpr const char* kCompiler = __VERSION__;
#else
inline constexpr const char* kCompiler = "GCC " __VERSION__;
#endif

#if defined(__AVX512F__)
inline constexpr const char* kInstructions = "AVX-512";
#elif defined(__AVX2__) && defined(__FMA__)
inline constexpr const char* kInstructions = "AVX2 and FMA";
#elif defined(__AVX2__)
inline constexpr const char* kInstructions = "AVX2";
#elif defined(__AVX__)
inline constexpr const char* kInstructions = "AVX";
#elif defined(__SSE4_2__)
inline constexpr const char* kInstructions = "SSE4.2";
#else
inline constexpr const char* kInstructions = "the processor family's baseline";
#endif

#if defined(__OPTIMIZE__)
inline constexpr bool kOptimized = true;
#else
inline constexpr bool kOptimized = false;
#endif

}  // namespace plugin_stamp

/// The stamp of the code that includes this header.
inline constexpr PluginStamp kPluginStamp{plugin_stamp::kMagic,       kPluginInterface,
                                          plugin_stamp::kOptimized,   plugin_stamp::kLayout,
                                          plugin_stamp::kLibrary,     plugin_stamp::kCompiler,
                                          plugin_stamp::kInstructions};

}  // namespace beambench::plugin
