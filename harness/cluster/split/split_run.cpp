#include "harness/cluster/split/split_run.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "harness/bench/record/machine.hpp"
#include "harness/cluster/run.hpp"
#include "harness/cluster/split/part_member.hpp"
#include "harness/cluster/split/scene_division.hpp"
#include "harness/rays/fingerprint.hpp"
#include "harness/rays/hit_check.hpp"
#include "harness/render/picture/image_file.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/core/files.hpp"
#include "scenes/core/json_text.hpp"

namespace beambench::cluster {
namespace {

using Json = nlohmann::ordered_json;

/// A process's part, and facts of the whole scene.
struct Setup {
  Identity identity;
  std::uint64_t whole_bytes = 0;
  std::unique_ptr<PartState> state;
};

Setup set_up(const Job& job, Transport& transport, std::vector<std::string>* warnings) {
  auto whole = std::make_shared<const scenes::Scene>(scenes::load_scene(job.scene, warnings));
  Setup place{{visible_hash(*whole), whole->primitives.size(), 0, 0},
              scenes::memory_bytes(*whole),
              nullptr};
  place.state = std::make_unique<PartState>(std::move(whole), job, transport);
  return place;
}

Json to_json(const PartReport& report) {
  return {{"primitives", report.primitives},
          {"scene_bytes", report.scene_bytes},
          {"structure_bytes", report.structure_bytes},
          {"beams_out", report.beams_out},
          {"rays_out", report.rays_out},
          {"crossings_out", to_json(report.crossings_out)},
          {"crossings_in", to_json(report.crossings_in)},
          {"cpu_seconds", report.cpu_seconds},
          {"wait_seconds", report.wait_seconds}};
}

}  // namespace

SplitRun lead_split(const ClusterRequest& request, Transport& transport) {
  Setup place;
  set_up_producer(transport, [&](std::vector<std::string>& warnings) {
    place = set_up(request.job, transport, &warnings);
  });
  const auto check = [&](ProcessId process, std::span<const std::byte> ready_report) {
    read_ready_report(process, ready_report, place.identity);
  };
  SplitRun run;
  run.job = request.job;
  run.whole_scene_bytes = place.whole_bytes;
  run.whole_primitives = place.identity.primitives;
  const double begin = transport.seconds();
  PartState& state = *place.state;
  PartMember member(transport, *state.worker, state.outbox, request.producer.timeout, check);
  std::vector<Bytes> results = member.lead();
  results[kProducer] = write_result(member.report(), *state.worker);
  const accel::PrimaryRays& rays = state.rays;
  accel::HitBuffer hits(rays.width(), rays.height(), rays.samples());
  for (const Bytes& result : results) run.reports.push_back(take_result(result, hits));
  run.seconds = transport.seconds() - begin;
  run.result_hash = rays::fingerprint(hits);
  run.job.resolution = {rays.width(), rays.height()};
  if (!request.picture.empty()) {
    // The ids are those of the whole scene, of which each process has a part.
    rays::HitCheck(run.whole_primitives, "structure 'beam'").require(hits, rays);
    render::write_image(request.picture,
                        render::shade(state.worker->scene(), rays, hits, request.shading));
  }
  if (!request.report.empty()) write_file(request.report, json_text(to_json(run)) + "\n");
  return run;
}

void follow_split(const Job& job, Transport& transport) {
  const auto place = set_up_consumer(transport, [&] { return set_up(job, transport, nullptr); });
  if (!place) return;
  transport.send(kProducer, Tag::kReady,
                 write_ready_report({host_name(), "", place->identity, 0.0, 0}));
  PartWorker& worker = *place->state->worker;
  PartMember member(transport, worker, place->state->outbox, 5.0 * job.heartbeat_interval,
                    [](ProcessId, std::span<const std::byte>) {});
  member.follow([&] { return write_result(member.report(), worker); });
}

nlohmann::ordered_json to_json(const SplitRun& run) {
  const bench::BuildInfo& build = bench::build_info();
  Json json{{"version", build.version},
            {"commit", build.commit},
            {"dirty", build.dirty},
            {"scene", run.job.scene},
            {"structure", run.job.structure},
            {"width", run.job.resolution.width},
            {"height", run.job.resolution.height},
            {"samples", run.job.samples},
            {"work", "parts"},
            {"cells_level", run.job.split_level},
            {"division", division_names()[static_cast<std::size_t>(run.job.division)]},
            {"processes", run.reports.size()},
            {"seconds", run.seconds},
            {"result_hash", fmt::format("{:016x}", run.result_hash)},
            {"whole_primitives", run.whole_primitives},
            {"whole_scene_bytes", run.whole_scene_bytes}};
  Json& each = json["each"] = Json::array();
  for (const PartReport& report : run.reports) each.push_back(to_json(report));
  return json;
}

std::string summary(const SplitRun& run) {
  Traffic crossings;
  std::uint64_t beams = 0;
  std::uint64_t rays = 0;
  std::uint64_t most = 0;
  std::uint64_t largest = 0;
  for (const PartReport& report : run.reports) {
    crossings += report.crossings_out;
    beams += report.beams_out;
    rays += report.rays_out;
    most = std::max(most, report.primitives);
    largest = std::max(largest, report.scene_bytes + report.structure_bytes);
  }
  return fmt::format(
      "{} processes in {:.3f} s; {} beams and {} rays were handed over in {} messages with {:.2f} "
      "MB; the largest part has {} of {} primitives and {:.2f} MB with its octree",
      run.reports.size(), run.seconds, beams, rays, crossings.messages,
      1e-6 * static_cast<double>(crossings.bytes), most, run.whole_primitives,
      1e-6 * static_cast<double>(largest));
}

}  // namespace beambench::cluster
