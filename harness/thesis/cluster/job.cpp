#include "harness/thesis/cluster/job.hpp"

#include <array>
#include <concepts>
#include <optional>
#include <tuple>
#include <type_traits>

#include <fmt/format.h>
#include <unistd.h>

#include "harness/measure/record/machine.hpp"
#include "harness/rays/fingerprint.hpp"
#include "harness/rays/trace_input.hpp"
#include "scenes/base/error.hpp"
#include "scenes/scene.hpp"

namespace beambench::cluster {
namespace {

constexpr std::uint32_t kMagic = 0x62624331;  // "1Cbb"

std::string this_version() {
  const measure::BuildInfo& build = measure::build_info();
  return fmt::format("{}, commit {}{}", build.version, build.commit,
                     build.dirty ? " with changes" : "");
}

void write_version(ByteWriter& writer) {
  writer.put(kMagic);
  writer.put_text(this_version());
}

/// Reads the version. In all versions, every process's first message begins with it.
std::string read_version(ByteReader& reader) {
  if (reader.get<std::uint32_t>() != kMagic) {
    throw InputError(
        "a process of this run has a different program; start the same program everywhere");
  }
  return reader.get_text();
}

/// Visits the transmitted members of a job in order; the argument may be const.
template <class AJob>
auto members(AJob& job) requires std::same_as<std::remove_const_t<AJob>, Job> {
  return std::tie(job.scene, job.structure, job.camera, job.resolution.width, job.resolution.height,
                  job.samples, job.light, job.whitted.max_depth, job.whitted.min_weight,
                  job.whitted.shadows, job.split_level, job.division, job.work, job.stored,
                  job.heartbeat_interval);
}

/// Visits the transmitted members of a report after its host and problem.
template <class Report>
auto members(Report& report) requires std::same_as<std::remove_const_t<Report>, ReadyReport> {
  return std::tie(report.identity.scene, report.identity.primitives, report.identity.nodes,
                  report.identity.references, report.build_seconds, report.structure_bytes);
}

}  // namespace

accel::StructureChoice beam_choice(const Job& job) {
  accel::StructureChoice choice = accel::registry().choose(parse_spec(job.structure));
  if (choice.info().name != "beam") {
    throw InputError(
        fmt::format("{} does not trace beams; the cluster needs 'beam', with or without parameters",
                    choice.info().name));
  }
  return choice;
}

rays::ImageOfRays job_image(const Job& job, const scenes::Scene& scene) {
  const scenes::Camera camera =
      job.camera.empty() ? scene.cameras.front() : scenes::find_camera(scene, job.camera);
  const auto resolution = job.resolution.width > 0 ? std::optional(job.resolution) : std::nullopt;
  return rays::image_of(camera, resolution, job.samples);
}

Bytes write_job(const Job& job) {
  Bytes bytes;
  ByteWriter writer(bytes);
  write_version(writer);
  writer.put(members(job));
  return bytes;
}

Job read_job(std::span<const std::byte> bytes) {
  ByteReader reader(bytes);
  if (const std::string version = read_version(reader); version != this_version()) {
    throw InputError(
        fmt::format("this is version {}, but the producer is version {}; start the "
                    "same program everywhere",
                    this_version(), version));
  }
  Job job;
  reader.get(members(job));
  return job;
}

std::uint64_t visible_hash(const scenes::Scene& scene) {
  Bytes looks;
  ByteWriter writer(looks);
  const auto put = [&](const glm::vec3& vector) {
    for (int i = 0; i < 3; ++i) writer.put(vector[i]);
  };
  writer.put(scenes::scene_hash(scene));
  put(scene.background);
  for (const scenes::Light& light : scene.lights) {
    put(light.position);
    put(light.color);
  }
  for (const scenes::Surface& surface : scene.surfaces) {
    put(surface.color);
    for (const float number : {surface.diffuse, surface.specular, surface.shine,
                               surface.transmittance, surface.refraction_index}) {
      writer.put(number);
    }
    writer.put(static_cast<std::uint8_t>(surface.finish));
  }
  for (const scenes::Primitive& primitive : scene.primitives) {
    writer.put(static_cast<std::uint32_t>(primitive.surface));
  }
  for (const scenes::Camera& camera : scene.cameras) {
    writer.put_text(camera.name);
    put(camera.from);
    put(camera.at);
    put(camera.up);
    for (const float number : {camera.angle, camera.aspect}) writer.put(number);
    writer.put(camera.width);
    writer.put(camera.height);
  }
  return rays::fingerprint(
      std::string_view(reinterpret_cast<const char*>(looks.data()), looks.size()));
}

Bytes write_ready_report(const ReadyReport& ready_report) {
  Bytes bytes;
  ByteWriter writer(bytes);
  write_version(writer);
  writer.put(std::tie(ready_report.host, ready_report.problem));
  writer.put(members(ready_report));
  return bytes;
}

ReadyReport read_ready_report(int process, std::span<const std::byte> bytes, const Identity& mine) {
  ByteReader reader(bytes);
  const std::string version = read_version(reader);
  ReadyReport ready_report;
  ready_report.host = reader.get_text();
  const std::string who = fmt::format("process {} on {}", process, ready_report.host);
  if (version != this_version()) {
    throw InputError(
        fmt::format("{} is version {}, but process 0 is version {}; start the same "
                    "program everywhere",
                    who, version, this_version()));
  }
  ready_report.problem = reader.get_text();
  if (!ready_report.problem.empty()) {
    throw InputError(fmt::format("{}: {}", who, ready_report.problem));
  }
  reader.get(members(ready_report));
  if (ready_report.identity.scene != mine.scene) {
    throw InputError(
        fmt::format("{} has a different scene of that name (hash {:016x}; process 0 has "
                    "{:016x}); use the same file for all of them",
                    who, ready_report.identity.scene, mine.scene));
  }
  if (ready_report.identity != mine) {
    const auto text = [](const Identity& identity) {
      return fmt::format("{} primitives, {} nodes, {} references", identity.primitives,
                         identity.nodes, identity.references);
    };
    throw InputError(
        fmt::format("{} built a different octree of the scene ({}; process 0: {}); start the same "
                    "build everywhere",
                    who, text(ready_report.identity), text(mine)));
  }
  return ready_report;
}

std::string host_name() {
  std::array<char, 256> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0) return "unnamed machine";
  return name.data();
}

}  // namespace beambench::cluster
