#include "harness/bench/record/manifest.hpp"

#include <fmt/format.h>

#include "harness/bench/record/build_info.hpp"
#include "harness/rays/fingerprint.hpp"

namespace beambench::bench {
namespace {

using Json = nlohmann::ordered_json;

// The layout of the files of a run. Counted up when a reader of the old one would err.
constexpr int kRecordVersion = 1;

constexpr std::string_view kLibraryNote =
    "google-benchmark.json says library_build_type 'debug' where the system's Google Benchmark was "
    "built without NDEBUG, as Debian's is; that slows its own loop, of which nothing is timed here "
    "(times are taken by beambench and handed over). beambench's own build type is in 'program'.";

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
          {"memory_bytes", machine.memory_bytes},
          {"kernel", machine.kernel},
          {"instructions", machine.instructions},
          {"virtual_machine", machine.virtual_machine},
          {"page_bytes", machine.page_bytes},
          {"transparent_huge_pages", text_or_null(machine.huge_pages)},
          {"governor", text_or_null(machine.governor)},
          {"turbo", text_or_null(machine.turbo)},
          {"load_average", machine.load}};
}

Json measurement_json(const Manifest& manifest) {
  const MeasurementFacts& facts = manifest.measurement;
  return {{"threads", manifest.run.threads},
          {"isa", manifest.run.isa},
          {"simd_target", manifest.measurement.simd_target},
          {"flush_to_zero", facts.flush_to_zero},
          {"denormals_are_zero", facts.flush_to_zero},
          {"pinned", facts.pinned_core >= 0},
          {"pinned_core", facts.pinned_core >= 0 ? Json(facts.pinned_core) : Json()},
          {"mxcsr", fmt::format("0x{:04x}", facts.control_word)},
          {"warm_up_seconds", facts.warm_up_seconds},
          {"noise", facts.noise ? Json(*facts.noise) : Json()},
          {"hardware_counters",
           facts.hardware_problem.empty() ? Json(kHardwareEvents) : Json(facts.hardware_problem)},
          {"wall_clock", "steady_clock"},
          {"cpu_clock",
           manifest.run.threads == 1 ? "CLOCK_THREAD_CPUTIME_ID" : "CLOCK_PROCESS_CPUTIME_ID"}};
}

Json plugins_json(const std::vector<plugin::LoadedPlugin>& plugins) {
  Json list = Json::array();
  for (const plugin::LoadedPlugin& plugin : plugins) {
    list.push_back({{"file", plugin.file},
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

}  // namespace

void go_on(Manifest& now, const Json& before) {
  now.run.run_id = before.at("run_id").get<std::string>();
  now.begun_utc = before.at("time_utc").get<std::string>();
  now.earlier_parts = before.value("earlier_parts", Json::array());
  Json part = Json::object();
  for (const char* member : {"part_begun_utc", "machine", "measurement", "uncontrolled"}) {
    part[member] = before.value(member, Json());
  }
  now.earlier_parts.push_back(part);
  now.uncontrolled.push_back(
      fmt::format("The run was cut off and went on at {}.", now.part_begun_utc));
}

Json to_json(const Manifest& manifest) {
  return {{"record_version", kRecordVersion},
          {"run_id", manifest.run.run_id},
          {"sweep", manifest.sweep},
          {"time_utc", manifest.begun_utc},
          {"finished_utc", text_or_null(manifest.finished_utc)},
          {"program", program_json(manifest)},
          {"plugins", plugins_json(manifest.plugins)},
          {"machine", machine_json(manifest.machine)},
          {"measurement", measurement_json(manifest)},
          {"scenes", scenes_json(manifest.scenes)},
          {"harness_overhead", manifest.overhead},
          {"uncontrolled", manifest.uncontrolled},
          {"part_begun_utc", manifest.part_begun_utc},
          {"earlier_parts", manifest.earlier_parts},
          {"notes", {kLibraryNote}}};
}

}  // namespace beambench::bench
