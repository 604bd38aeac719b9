#pragma once
// How a generated scene grows with its size.

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

/// Generates the scene in growing sizes, each of about twice the primitives of the one before, as
/// long as they do not exceed the limit. `spec` is a catalogue name, with any parameters but the
/// one that is its size. Throws InputError when the scene has no size, or the smallest is too
/// large.
SceneGrowth measure_growth(const std::string& spec, std::size_t limit, base::Progress& progress);

}  // namespace beambench::measure
