// Sweeps: a configuration is read, checked and expanded; nothing is measured.

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

#include "accel/core/registry.hpp"
#include "harness/measure/config.hpp"
#include "harness/measure/plan.hpp"
#include "tests/fuzz/scratch_folder.hpp"
#include "tests/fuzz/target.hpp"

namespace {

using namespace beambench;

/// Returns whether the plan's scenes are quick to generate and need no files.
bool has_small_scenes(const measure::SweepConfig& config) {
  constexpr std::array<std::string_view, 3> kSmall{"tetra:n=1", "balls:n=1", "stetra"};
  return std::ranges::all_of(config.scenes, [&](const measure::SceneEntry& entry) {
    return std::ranges::find(kSmall, entry.spec) != kSmall.end();
  });
}

/// Returns whether there are few cells. They are created one by one, each with its names.
bool has_few_cells(const measure::SweepConfig& config) {
  constexpr std::size_t kFew = 2000;
  return config.scenes.size() * config.structures.size() * config.resolutions.size() *
             config.samples.size() * config.rays.size() <
         kFew;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::ScratchFolder folder;
  const auto file = folder.write("sweep.json", fuzz::text_of(data, size));
  const auto config = fuzz::accepted([&] { return measure::read_sweep(file, accel::registry()); });
  if (!config || !has_small_scenes(*config) || !has_few_cells(*config)) return 0;
  const auto plan = fuzz::accepted([&] { return measure::make_plan(*config); });
  if (!plan) return 0;
  fuzz::require(plan->cell_count() > 0, "a plan without cells was not refused");
  for (const measure::CellGroup& group : plan->groups) {
    for (const measure::PlannedCell& cell : group.cells) {
      fuzz::require(!measure::shown_name(cell.id).empty(), "a cell has no name");
    }
  }
  return 0;
}
