#include "harness/measure/cost.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string_view>

#include "accel/core/registry.hpp"

namespace beambench::measure {
namespace {

// Times in nanoseconds on one core in 2024, from the published runs.
constexpr double kOracleRay = 1500.0;
constexpr double kHarnessRay = 5.0;
constexpr double kExhaustiveTest = 5.0;  // one ray with one primitive
constexpr double kRayAtRoot = 40.0;
constexpr double kRayPerLevel = 15.0;
constexpr double kBuildPrimitive = 500.0;

/// The cost of a repetition relative to its build and first trace alone. Includes the second trace,
/// the measurement of the clock rate and the verification.
constexpr double kBesideRepetition = 1.5;

double levels(const CellGroup& group) {
  return static_cast<double>(std::bit_width(group.scene->primitives.size()));
}

/// Returns the number of rays per sample of the image; for a picture, shading included.
double rays_per_sample(const CellGroup& group) {
  const auto lights = static_cast<double>(std::max<std::size_t>(group.scene->lights.size(), 1));
  switch (group.rays.kind) {
    case rays::RayKind::kShadow:
      return lights;
    case rays::RayKind::kArea:
      return lights * static_cast<double>(rays::parameters_of(group.rays).integer("samples"));
    case rays::RayKind::kOcclusion:
      return static_cast<double>(rays::parameters_of(group.rays).integer("samples"));
    case rays::RayKind::kPath:
      return static_cast<double>(rays::parameters_of(group.rays).integer("bounces"));
    case rays::RayKind::kWhitted:
      return 3.0 + lights;
    default:
      return 1.0;
  }
}

/// Returns the time of build and trace.
double repetition_ns(const CellGroup& group, std::string_view structure) {
  const auto primitives = static_cast<double>(group.scene->primitives.size());
  if (structure == "null") return kHarnessRay * estimated_rays(group);
  if (structure == "exhaustive") {
    return (kHarnessRay + kExhaustiveTest * primitives) * estimated_rays(group);
  }
  return kBuildPrimitive * primitives +
         (kRayAtRoot + kRayPerLevel * levels(group)) * estimated_rays(group);
}

}  // namespace

double estimated_rays(const CellGroup& group) {
  return static_cast<double>(group.resolution.width) *
         static_cast<double>(group.resolution.height) * static_cast<double>(group.samples) *
         rays_per_sample(group);
}

double estimated_ns(const CellGroup& group, const SweepConfig& config, double allowance_ns) {
  double sum = kOracleRay * estimated_rays(group);
  for (const PlannedCell& cell : group.cells) {
    const double once = repetition_ns(group, cell.structure.info().name);
    const double repeated = kBesideRepetition * once;
    sum += once + std::clamp(allowance_ns, repeated * config.minimum_repetitions,
                             repeated * config.maximum_repetitions);
  }
  return sum;
}

}  // namespace beambench::measure
