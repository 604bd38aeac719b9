#include "harness/cluster/job.hpp"

#include <fmt/format.h>

#include "harness/bench/record/build_info.hpp"
#include "harness/cli/inputs.hpp"
#include "harness/rays/fingerprint.hpp"
#include "scenes/core/error.hpp"

namespace beambench::cluster {
namespace {

constexpr std::uint32_t kMagic = 0x62624331;  // "1Cbb": nothing that comes by chance

std::string this_version() {
  const bench::BuildInfo& build = bench::build_info();
  return fmt::format("{}, commit {}{}", build.version, build.commit,
                     build.dirty ? " with changes" : "");
}

void write_version(ByteWriter& writer) {
  writer.put(kMagic);
  writer.put_text(this_version());
}

/// Every message that a process sends first begins so, in all versions.
std::string read_version(ByteReader& reader) {
  if (reader.get<std::uint32_t>() != kMagic) {
    throw InputError("a process of this run is another program; start the same one everywhere");
  }
  return reader.get_text();
}

}  // namespace

rays::ImageOfRays job_image(const Job& job, const scenes::Scene& scene) {
  cli::ImageRequest request{"", {}, job.samples};
  request.view.camera = job.camera;
  if (job.width > 0) request.resolution = rays::to_string(rays::Resolution{job.width, job.height});
  return cli::choose_image(scene, request);
}

Bytes write_job(const Job& job) {
  Bytes bytes;
  ByteWriter writer(bytes);
  write_version(writer);
  writer.put_text(job.scene);
  writer.put_text(job.structure);
  writer.put_text(job.camera);
  writer.put(job.width);
  writer.put(job.height);
  writer.put(job.samples);
  writer.put(job.light);
  writer.put(job.whitted.max_depth);
  writer.put(job.whitted.least_weight);
  writer.put(static_cast<std::int32_t>(job.whitted.shadows));
  writer.put(job.split_level);
  writer.put(job.alive_every);
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
  job.scene = reader.get_text();
  job.structure = reader.get_text();
  job.camera = reader.get_text();
  job.width = reader.get<int>();
  job.height = reader.get<int>();
  job.samples = reader.get<int>();
  job.light = reader.get<bool>();
  job.whitted.max_depth = reader.get<int>();
  job.whitted.least_weight = reader.get<double>();
  job.whitted.shadows = static_cast<render::ShadowMethod>(reader.get<std::int32_t>());
  job.split_level = reader.get<int>();
  job.alive_every = reader.get<double>();
  return job;
}

std::uint64_t look_hash(const scenes::Scene& scene) {
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

Bytes write_introduction(const Introduction& introduction) {
  Bytes bytes;
  ByteWriter writer(bytes);
  write_version(writer);
  writer.put_text(introduction.host);
  writer.put_text(introduction.problem);
  writer.put(introduction.identity.scene);
  writer.put(introduction.identity.nodes);
  writer.put(introduction.identity.references);
  writer.put(introduction.build_seconds);
  writer.put(introduction.structure_bytes);
  return bytes;
}

Introduction read_introduction(int process, std::span<const std::byte> bytes,
                               const Identity& mine) {
  ByteReader reader(bytes);
  const std::string version = read_version(reader);
  Introduction introduction;
  introduction.host = reader.get_text();
  const std::string who = fmt::format("process {} on {}", process, introduction.host);
  if (version != this_version()) {
    throw InputError(
        fmt::format("{} is version {}, but process 0 is version {}; start the same "
                    "program everywhere",
                    who, version, this_version()));
  }
  introduction.problem = reader.get_text();
  if (!introduction.problem.empty()) {
    throw InputError(fmt::format("{}: {}", who, introduction.problem));
  }
  introduction.identity.scene = reader.get<std::uint64_t>();
  introduction.identity.nodes = reader.get<std::uint64_t>();
  introduction.identity.references = reader.get<std::uint64_t>();
  introduction.build_seconds = reader.get<double>();
  introduction.structure_bytes = reader.get<std::uint64_t>();
  if (introduction.identity.scene != mine.scene) {
    throw InputError(
        fmt::format("{} has another scene under that name (hash {:016x}, process 0 "
                    "has {:016x}); give all of them the same file",
                    who, introduction.identity.scene, mine.scene));
  }
  if (introduction.identity != mine) {
    throw InputError(
        fmt::format("{} made another octree of the scene ({} nodes, {} references; "
                    "process 0 made {} and {}); start the same build everywhere",
                    who, introduction.identity.nodes, introduction.identity.references, mine.nodes,
                    mine.references));
  }
  return introduction;
}

}  // namespace beambench::cluster
