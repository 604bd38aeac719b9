#include "harness/plugin/program_contender.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "accel/core/support.hpp"
#include "harness/base/stopwatch.hpp"
#include "harness/plugin/batch_structure.hpp"
#include "harness/plugin/program_process.hpp"
#include "harness/plugin/scene_arrays.hpp"
#include "harness/plugin/shared_memory.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/printable.hpp"

namespace beambench::plugin {
namespace {

/// The time limit for the description: interpreters that import large libraries take many seconds
/// on a busy machine.
constexpr double kSecondsToDescribe = 120.0;
constexpr std::string_view kMagic = "BEAMSCN1";

/// Appends arrays to memory.
class Writer {
 public:
  explicit Writer(std::byte* at) : at_(at) {}
  template <class T>
  void write(const T* items, std::size_t count) {
    if (count > 0) std::memcpy(at_, items, count * sizeof(T));
    at_ += count * sizeof(T);
  }

 private:
  std::byte* at_;
};

void write_scene(const beambench_scene& scene, SharedMemory& memory) {
  const std::array<std::uint64_t, 5> counts{scene.primitive_count, scene.vertex_count,
                                            scene.triangle_count, scene.sphere_count,
                                            scene.cone_count};
  Writer out(memory.at_least(
      kMagic.size() + sizeof(counts) + scene.vertex_count * 3 * sizeof(float) +
      scene.triangle_count * sizeof(beambench_triangle) +
      scene.sphere_count * sizeof(beambench_sphere) + scene.cone_count * sizeof(beambench_cone)));
  out.write(kMagic.data(), kMagic.size());
  out.write(counts.data(), counts.size());
  out.write(scene.vertices, 3 * scene.vertex_count);
  out.write(scene.triangles, scene.triangle_count);
  out.write(scene.spheres, scene.sphere_count);
  out.write(scene.cones, scene.cone_count);
}

/// The program's processes that no structure uses. They are kept for reuse, because starting an
/// interpreter may take seconds.
class IdleProcesses {
 public:
  explicit IdleProcesses(std::string file) : file_(std::move(file)) {}

  std::unique_ptr<ProgramProcess> take() {
    const std::lock_guard lock(changing_);
    if (idle_.empty()) return std::make_unique<ProgramProcess>(file_);
    auto process = std::move(idle_.back());
    idle_.pop_back();
    return process;
  }
  void give_back(std::unique_ptr<ProgramProcess> process) {
    const std::lock_guard lock(changing_);
    if (process->is_running()) idle_.push_back(std::move(process));
  }
  const std::string& file() const { return file_; }

 private:
  std::string file_;
  std::mutex changing_;
  std::vector<std::unique_ptr<ProgramProcess>> idle_;
};

/// A program that has built one scene.
class ProgramTracer final : public BatchTracer {
 public:
  ProgramTracer(std::shared_ptr<IdleProcesses> idle, std::string version,
                const scenes::Scene& scene, double timeout)
      : idle_(std::move(idle)),
        version_(std::move(version)),
        timeout_(timeout),
        process_(idle_->take()) {
    SharedMemory memory;
    write_scene(SceneArrays(scene).view(), memory);
    build_seconds_ = ask(fmt::format("build {}", memory.path()));
  }

  ~ProgramTracer() override { idle_->give_back(std::move(process_)); }

  void closest_hits(const beambench_batch& batch, float* t,
                    std::uint32_t* primitive) const override {
    const std::lock_guard lock(asking_);
    const std::byte* results = trace("closest", batch, sizeof(float) + sizeof(std::uint32_t));
    std::memcpy(t, results, batch.count * sizeof(float));
    std::memcpy(primitive, results + batch.count * sizeof(float),
                batch.count * sizeof(std::uint32_t));
  }
  void any_hits(const beambench_batch& batch, std::uint8_t* hits) const override {
    const std::lock_guard lock(asking_);
    std::memcpy(hits, trace("any", batch, 1), batch.count);
  }
  accel::Statistics statistics() const override {
    const std::lock_guard lock(asking_);
    accel::Statistics statistics;
    statistics.library_version = version_ + kSelfReportedNote;
    statistics.more = {{kSelfReportedBuild, 1e3 * build_seconds_},
                       {kSelfReportedTrace, 1e3 * trace_seconds_}};
    return statistics;
  }
  /// Returns true, so that the program reports one time for a query.
  bool takes_whole_queries() const override { return true; }

 private:
  /// Runs a query; returns the address of its results.
  const std::byte* trace(std::string_view query, const beambench_batch& batch,
                         std::size_t result_bytes) const {
    const std::size_t ray_bytes = batch.count * sizeof(beambench_ray);
    std::byte* memory = memory_.at_least(ray_bytes + batch.count * result_bytes);
    std::memcpy(memory, batch.rays, ray_bytes);
    // Overwrites earlier results, so that results that the program fails to write are detected.
    std::memset(memory + ray_bytes, 0xCD, batch.count * result_bytes);
    trace_seconds_ = ask(fmt::format("{} {} {}", query, memory_.path(), batch.count));
    return memory + ray_bytes;
  }

  /// Sends a request and returns the seconds that the program reports.
  double ask(const std::string& request) const {
    const base::Stopwatch stopwatch;
    const std::string answer = process_->request(request, timeout_);
    const double round_trip = stopwatch.seconds();
    const std::string_view verb = std::string_view(request).substr(0, request.find(' '));
    const std::size_t space = std::min(answer.find(' '), answer.size());
    const std::string_view word = std::string_view(answer).substr(0, space);
    const std::string_view rest =
        std::string_view(answer).substr(std::min(space + 1, answer.size()));
    if (word == "unsupported") {
      throw accel::UnsupportedError(
          fmt::format("{} declines '{}': {}", idle_->file(), verb, printable(std::string(rest))));
    }
    double seconds = 0.0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), seconds);
    if (word != "ok" || error != std::errc{} || end != rest.data() + rest.size() ||
        !(seconds >= 0.0)) {
      throw PluginError(
          fmt::format("the program {} answered '{}' to '{}'; expected 'ok SECONDS', 'unsupported "
                      "REASON' or 'error TEXT'",
                      idle_->file(), printable(answer), verb));
    }
    if (seconds > round_trip) {
      throw PluginError(
          fmt::format("the program {} reports {} s for '{}', longer than the {} s from the request "
                      "to the answer; report seconds of a steady clock",
                      idle_->file(), seconds, verb, round_trip));
    }
    return seconds;
  }

  std::shared_ptr<IdleProcesses> idle_;
  std::string version_;
  double timeout_;
  mutable std::mutex asking_;  ///< a program serves one request at a time
  std::unique_ptr<ProgramProcess> process_;
  mutable SharedMemory memory_;
  double build_seconds_ = 0.0;
  mutable double trace_seconds_ = 0.0;
};

/// Returns a string member of a description; an empty string if it is missing.
std::string text_of(const nlohmann::json& description, const char* member) {
  if (!description.contains(member)) return "";
  if (!description[member].is_string()) {
    throw PluginError(fmt::format("describes itself with a '{}' that is not a string", member));
  }
  return description[member].get<std::string>();
}

accel::Support support_of(const nlohmann::json& description) {
  accel::Support support{.spheres = false, .cones = false, .polygons = false};
  const auto kinds = description.value("primitives", nlohmann::json::array({"polygons"}));
  for (const auto& kind : kinds) {
    if (kind == "polygons") {
      support.polygons = true;
    } else if (kind == "spheres") {
      support.spheres = true;
    } else if (kind == "cones") {
      support.cones = true;
    } else {
      throw PluginError(fmt::format(
          "describes itself with the primitives {}; expected a list of polygons, spheres, cones",
          kinds.dump()));
    }
  }
  return support;
}

}  // namespace

accel::StructureInfo structure_of_program(const std::string& file) {
  auto idle = std::make_shared<IdleProcesses>(file);
  auto process = idle->take();
  const std::string answer = process->request("describe", kSecondsToDescribe);
  idle->give_back(std::move(process));
  const auto description = nlohmann::json::parse(answer, nullptr, /*allow_exceptions=*/false);
  if (!description.is_object()) {
    throw PluginError(fmt::format("answers '{}' to 'describe'; expected a JSON object in one line",
                                  printable(answer)));
  }
  return {text_of(description, "name"),
          text_of(description, "description"),
          accel::Conformance::kTolerance,
          {integer_parameter("timeout", 60, 1, 86400,
                             "seconds within which the program must answer a request")},
          [idle, version = text_of(description, "version")](
              const scenes::Scene& scene, const Parameters& parameters, const accel::Workload&) {
            return structure_of(std::make_unique<ProgramTracer>(
                idle, version, scene, static_cast<double>(parameters.integer("timeout"))));
          },
          support_of(description)};
}

}  // namespace beambench::plugin
