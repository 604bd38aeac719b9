#pragma once
// Measures how a generated scene grows with its size parameter.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "harness/base/progress.hpp"

namespace beambench::measure {

struct GrownScene {
  std::string scene;
  std::int64_t size;
  std::size_t primitives;
  std::size_t bytes;  ///< held by the scene's arrays
  double seconds;     ///< wall time to generate it
};

struct SceneGrowth {
  std::string generator;
  std::string size_parameter;
  std::vector<GrownScene> sizes;
};

inline constexpr std::size_t kMaxGrowth = 10'000'000;

/// Generates the scene in growing sizes, each with about twice as many primitives as the previous
/// one, up to the limit. `spec` is a catalogue name, with any parameters except its size. Throws
/// InputError if the scene has no size parameter, or if even the smallest scene is too large.
SceneGrowth measure_growth(const std::string& spec, std::size_t limit, base::Progress& progress);

}  // namespace beambench::measure
