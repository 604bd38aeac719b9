#include "accel/core/build_memory.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

#include <fmt/format.h>

#include "scenes/base/error.hpp"
#include "scenes/base/process_memory.hpp"
#include "scenes/subset.hpp"

namespace beambench::accel {
namespace {

/// The largest number of bytes per primitive that any known build takes if no list exceeds its cap.
constexpr std::uint64_t kMaxBytesPerPrimitive = 2048;

/// The minimum number of primitives for a prediction: with fewer, the allocator's reserve exceeds
/// the measured memory.
constexpr std::size_t kMinPrimitives = std::size_t{1} << 17U;

/// Returns every `stride`-th run of primitives. Neighbors in a mesh stay together, so that they
/// share vertices and leaves as in the whole scene.
scenes::Scene part_of(const scenes::Scene& scene, std::size_t stride) {
  constexpr std::size_t kRun = 4096;
  std::vector<scenes::PrimitiveId> ids;
  for (std::size_t id = 0; id < scene.primitives.size(); ++id) {
    if (id / kRun % stride == 0) ids.push_back(static_cast<scenes::PrimitiveId>(id));
  }
  return scenes::subset(scene, ids);
}

double gibibytes(double bytes) { return bytes * 0x1p-30; }

}  // namespace

std::optional<std::uint64_t> predicted_build_bytes(const StructureChoice& choice,
                                                   const scenes::Scene& scene,
                                                   const Workload& workload) {
  const auto measure = [&](const scenes::Scene& part) {
    return peak_memory_growth([&] { choice.info().build(part, choice.parameters(), workload); });
  };
  try {
    measure(part_of(scene, 64));  // one-time work of a first build, such as starting threads
    const scenes::Scene part = part_of(scene, 8);
    const auto bytes = measure(part);
    if (!bytes) return std::nullopt;
    const double share =
        static_cast<double>(scene.primitives.size()) / static_cast<double>(part.primitives.size());
    return static_cast<std::uint64_t>(share * static_cast<double>(*bytes));
  } catch (const InputError&) {  // a cap is exceeded; the build itself reports it better
    return std::nullopt;
  }
}

void require_build_memory(const StructureChoice& choice, const scenes::Scene& scene,
                          const Workload& workload) {
  const auto available = available_memory();
  const std::uint64_t most = kMaxBytesPerPrimitive * scene.primitives.size();
  if (!available || most <= *available || scene.primitives.size() < kMinPrimitives) return;
  const auto needed = predicted_build_bytes(choice, scene, workload);
  if (!needed || *needed <= *available) return;
  throw InputError(fmt::format(
      "'{}' over the {} primitives of '{}' would take about {:.2f} GiB of memory (predicted from a "
      "build over an eighth of them), but {:.2f} GiB are available; choose another structure, "
      "close other programs, or set BEAMBENCH_MEMORY to the memory that may be used",
      choice.short_label(), scene.primitives.size(), scene.name,
      gibibytes(static_cast<double>(*needed)), gibibytes(static_cast<double>(*available))));
}

}  // namespace beambench::accel
