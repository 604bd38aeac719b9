#include "harness/measure/record/manifest.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "accel/core/instruction_set.hpp"
#include "accel/embree/isa.hpp"
#include "harness/measure/measurement.hpp"
#include "harness/measure/record/cell_record.hpp"
#include "harness/measure/record/machine.hpp"
#include "harness/rays/fingerprint.hpp"
#include "scenes/base/printable.hpp"

namespace beambench::measure {
namespace {

using Json = nlohmann::ordered_json;

// The version of the layout of a run's files. Incremented when programs made for the old layout
// would fail.
constexpr int kRecordVersion = 1;

constexpr std::string_view kLibraryNote =
    "google-benchmark.json reports library_build_type 'debug' where the system's Google Benchmark "
    "was built without NDEBUG, as Debian's is; that slows its own loop, which is not timed here "
    "(beambench measures times itself). beambench's own build type is in 'program'.";

Json text_or_null(const std::string& text) { return text.empty() ? Json() : Json(text); }

Json program_json(const Manifest& manifest) {
  const BuildInfo& info = build_info();
  Json libraries = Json::object();
  for (const auto& [name, version] : info.libraries) {
    libraries[std::string(name)] = text_or_null(std::string(version));
  }
  return {{"version", info.version},
          {"commit", info.commit},
          {"dirty", info.dirty},
          {"build_type", info.build_type},
          {"compiler", info.compiler},
          {"flags", info.flags},
          {"executable_hash", rays::hex_digits(manifest.machine.executable_hash)},
          {"libraries", libraries}};
}

Json machine_json(const Machine& machine) {
  return {{"id", machine.id},
          {"cpu", machine.cpu},
          {"cores", machine.cores},
          {"cpu_quota", machine.cpu_quota ? Json(*machine.cpu_quota) : Json()},
          {"memory_bytes", machine.memory_bytes},
          {"kernel", machine.kernel},
          {"instructions", machine.instructions},
          {"virtual_machine", machine.virtual_machine},
          {"page_bytes", machine.page_bytes},
          {"transparent_huge_pages", text_or_null(machine.huge_pages)},
          {"governor", text_or_null(machine.governor)},
          {"turbo", text_or_null(machine.turbo)}};
}

Json measurement_json(const Manifest& manifest) {
  const MeasurementFacts& facts = manifest.measurement;
  return {{"threads", manifest.run.threads},
          {"isa", manifest.run.isa},
          {"simd_target", facts.simd_target},
          {"flush_to_zero", facts.flush_to_zero},
          {"denormals_are_zero", facts.flush_to_zero},
          {"pinned", facts.pinned_core >= 0},
          {"pinned_core", facts.pinned_core >= 0 ? Json(facts.pinned_core) : Json()},
          {"mxcsr", fmt::format("0x{:04x}", facts.control_word)},
          {"warm_up_seconds", facts.warm_up_seconds},
          {"noise", facts.noise ? Json(*facts.noise) : Json()},
          {"other_work", facts.other_work ? Json(*facts.other_work) : Json()},
          {"throttling", to_json(facts.throttling)},
          {"hardware_counters",
           facts.hardware_problem.empty() ? Json(kHardwareEvents) : Json(facts.hardware_problem)},
          {"wall_clock", "steady_clock"},
          {"cpu_clock",
           manifest.run.threads == 1 ? "CLOCK_THREAD_CPUTIME_ID" : "CLOCK_PROCESS_CPUTIME_ID"}};
}

Json plugins_json(const std::vector<plugin::LoadedPlugin>& plugins) {
  Json list = Json::array();
  for (const plugin::LoadedPlugin& plugin : plugins) {
    list.push_back({{"file", name_of_path(plugin.file)},
                    {"hash", rays::hex_digits(plugin.hash)},
                    {"description", plugin.description},
                    {"compiler", plugin.compiler},
                    {"instructions", plugin.instructions},
                    {"optimized", plugin.optimized},
                    {"structures", plugin.structures},
                    {"scenes", plugin.scenes},
                    {"readers", plugin.readers}});
  }
  return list;
}

Json scenes_json(const std::vector<SceneFacts>& scenes) {
  Json list = Json::array();
  for (const SceneFacts& scene : scenes) {
    list.push_back({{"name", scene.name},
                    {"hash", rays::hex_digits(scene.hash)},
                    {"primitives", scene.primitives}});
  }
  return list;
}

std::string or_unknown(const std::string& text) { return text.empty() ? "unknown" : text; }

std::string hardware_line(const Manifest& manifest) {
  const Machine& machine = manifest.machine;
  const int core = manifest.measurement.pinned_core;
  return fmt::format(
      "machine: {}, {} cores{}, {}, Embree {}, MXCSR 0x{:04x}, {}, pages of {} KiB (huge: {})",
      machine.cpu, machine.cores,
      machine.cpu_quota ? fmt::format(" (quota: {:.3g} CPUs)", *machine.cpu_quota) : "",
      machine.instructions, manifest.run.isa, manifest.measurement.control_word,
      core < 0 ? "not pinned" : fmt::format("core {}", core), machine.page_bytes / 1024,
      or_unknown(machine.huge_pages));
}

std::string state_line(const Manifest& manifest) {
  const Machine& machine = manifest.machine;
  const auto& [noise, other] =
      std::tie(manifest.measurement.noise, manifest.measurement.other_work);
  return fmt::format(
      "machine: governor {}, turbo {}, other work {}, noise {}, hardware counters {}",
      or_unknown(machine.governor), or_unknown(machine.turbo),
      other ? fmt::format("{:.2f} processors", *other) : "not measured",
      noise ? fmt::format("{:.1f}%", 100.0 * *noise) : "not measured",
      manifest.measurement.hardware_problem.empty() ? "yes" : "no");
}

/// Returns `20240531-140709.417-default`, which sorts by time. It includes milliseconds because
/// small runs take less than a second and names must differ. Shards may begin in the same
/// millisecond: `20240531-140709.417-default-shard-2-of-4`.
std::string new_run_id(const std::string& sweep, const std::optional<ShardFacts>& shard) {
  const auto now = std::chrono::floor<std::chrono::milliseconds>(std::chrono::system_clock::now());
  const auto milliseconds = now.time_since_epoch().count() % 1000;
  return fmt::format(
      "{:%Y%m%d-%H%M%S}.{:03}-{}{}", fmt::gmtime(std::chrono::system_clock::to_time_t(now)),
      milliseconds, sweep,
      shard ? fmt::format("-shard-{}-of-{}", shard->shard.number, shard->shard.count) : "");
}

}  // namespace

void continue_with(Manifest& now, const Json& before) {
  now.run.run_id = before.at("run_id").get<std::string>();
  now.begun_utc = before.at("time_utc").get<std::string>();
  now.measurement.throttling = conditions_of(before).throttling;
  now.google_benchmark = before.value("google_benchmark", now.google_benchmark);
  now.earlier_parts = before.value("earlier_parts", Json::array());
  Json part = Json::object();
  for (const char* member : {"part_begun_utc", "machine", "measurement", "uncontrolled"}) {
    part[member] = before.value(member, Json());
  }
  now.earlier_parts.push_back(part);
  now.uncontrolled.push_back(
      fmt::format("The run was cut off and resumed at {}.", now.part_begun_utc));
}

Json to_json(const Manifest& manifest) {
  Json json{{"record_version", kRecordVersion},
            {"run_id", manifest.run.run_id},
            {"sweep", manifest.sweep},
            {"time_utc", manifest.begun_utc},
            {"finished_utc", text_or_null(manifest.finished_utc)},
            {"program", program_json(manifest)},
            {"plugins", plugins_json(manifest.plugins)},
            {"machine", machine_json(manifest.machine)},
            {"measurement", measurement_json(manifest)},
            {"scenes", scenes_json(manifest.scenes)},
            {"uncontrolled", manifest.uncontrolled},
            {"part_begun_utc", manifest.part_begun_utc},
            {"earlier_parts", manifest.earlier_parts},
            {"google_benchmark", manifest.google_benchmark},
            {"notes", {kLibraryNote}}};
  if (manifest.shard) json["shard"] = to_json(*manifest.shard);
  return json;
}

std::vector<std::string> preflight(const Manifest& manifest) {
  std::vector<std::string> lines{hardware_line(manifest), state_line(manifest)};
  for (const std::string& sentence : manifest.uncontrolled) {
    lines.push_back(fmt::format("warning: {}", sentence));
  }
  return lines;
}

Manifest begin_manifest(const std::string& sweep, std::vector<SceneFacts> scenes, int core,
                        int threads, std::chrono::duration<double> warm_up,
                        std::optional<ShardFacts> shard, const std::filesystem::path& root) {
  const BuildInfo& build = build_info();
  Manifest manifest;
  manifest.machine = inspect_machine(root);
  manifest.sweep = sweep;
  manifest.begun_utc = manifest.part_begun_utc = utc_now();
  manifest.shard = shard;
  manifest.run = {new_run_id(sweep, shard),
                  std::string(build.commit),
                  build.dirty,
                  manifest.machine.id,
                  std::string(build.build_type),
                  std::string(build.flags),
                  accel::embree::isa_in_use("best"),
                  threads};
  manifest.measurement = {MeasuringFloatMode::available(),
                          core,
                          MeasuringFloatMode::control_word(),
                          warm_up.count(),
                          accel::best_simd_target(),
                          std::nullopt,
                          std::nullopt,
                          "",
                          std::nullopt};
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
  if (const auto warning = quota_warning(manifest.machine.cpu_quota, threads)) {
    manifest.uncontrolled.push_back(*warning);
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

}  // namespace beambench::measure
