#include "harness/bench/begin_manifest.hpp"

#include <chrono>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "accel/core/instruction_set.hpp"
#include "accel/embree/version.hpp"
#include "harness/bench/conditions.hpp"
#include "harness/bench/record/build_info.hpp"

namespace beambench::bench {
namespace {

/// `20240531-140709.417-default`: sorts by time; milliseconds, since small runs take less than a
/// second and no two may have one name.
std::string new_run_id(const std::string& sweep) {
  const auto now = std::chrono::floor<std::chrono::milliseconds>(std::chrono::system_clock::now());
  const auto milliseconds = now.time_since_epoch().count() % 1000;
  return fmt::format("{:%Y%m%d-%H%M%S}.{:03}-{}",
                     fmt::gmtime(std::chrono::system_clock::to_time_t(now)), milliseconds, sweep);
}

RunFacts facts_of(const BuildInfo& build, const std::string& run_id, const Machine& machine,
                  int threads) {
  return {run_id,
          std::string(build.commit),
          build.dirty,
          machine.id,
          std::string(build.build_type),
          std::string(build.flags),
          accel::embree::embree_isa(),
          threads};
}

}  // namespace

Manifest begin_manifest(const std::string& sweep, std::vector<SceneFacts> scenes, int core,
                        int threads, std::chrono::duration<double> warm_up) {
  const BuildInfo& build = build_info();
  Manifest manifest;
  manifest.machine = inspect_machine();
  manifest.sweep = sweep;
  manifest.begun_utc = manifest.part_begun_utc = utc_now();
  manifest.run = facts_of(build, new_run_id(sweep), manifest.machine, threads);
  manifest.measurement = {MeasuringFloatMode::available(),
                          core,
                          MeasuringFloatMode::control_word(),
                          warm_up.count(),
                          accel::best_simd_target(),
                          std::nullopt,
                          ""};
  manifest.plugins.assign(plugin::loaded_plugins().begin(), plugin::loaded_plugins().end());
  manifest.scenes = std::move(scenes);
  manifest.uncontrolled = disturbances(manifest.machine);
  if (threads > 1) {
    manifest.uncontrolled.push_back(
        fmt::format("The {} threads that trace are not pinned to cores.", threads));
    if (std::cmp_greater(threads, manifest.machine.cores)) {
      manifest.uncontrolled.push_back(
          fmt::format("There are {} threads for {} cores.", threads, manifest.machine.cores));
    }
  } else if (core < 0) {
    manifest.uncontrolled.emplace_back("The measuring thread could not be pinned.");
  }
  if (build.build_type != "Release") {
    manifest.uncontrolled.push_back(
        fmt::format("beambench was built as '{}', not as Release.", build.build_type));
  }
  for (const plugin::LoadedPlugin& plugin : manifest.plugins) {
    if (plugin.optimized) continue;
    manifest.uncontrolled.push_back(
        fmt::format("The plug-in {} was built without optimization.", plugin.file));
  }
  return manifest;
}

}  // namespace beambench::bench
