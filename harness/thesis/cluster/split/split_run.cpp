#include "harness/thesis/cluster/split/split_run.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "harness/measure/record/machine.hpp"
#include "harness/rays/fingerprint.hpp"
#include "harness/rays/hit_check.hpp"
#include "harness/render/picture/image_file.hpp"
#include "harness/thesis/cluster/run.hpp"
#include "harness/thesis/cluster/split/light_run.hpp"
#include "harness/thesis/cluster/split/part_member.hpp"
#include "harness/thesis/cluster/split/scene_division.hpp"
#include "scenes/base/files.hpp"
#include "scenes/base/json_text.hpp"
#include "scenes/catalogue.hpp"

namespace beambench::cluster {
namespace {

using Json = nlohmann::ordered_json;

/// A process's part, and facts about the whole scene.
struct Setup {
  Identity identity;
  std::uint64_t whole_bytes = 0;
  std::unique_ptr<PartState> state;
};

std::shared_ptr<const scenes::Scene> load_whole(const Job& job,
                                                std::vector<std::string>* warnings) {
  return std::make_shared<const scenes::Scene>(scenes::load_scene(job.scene, warnings));
}

/// Sets up a process. The whole scene is freed unless the caller keeps it.
Setup set_up(std::shared_ptr<const scenes::Scene> whole, const Job& job, Transport& transport) {
  Setup place{{visible_hash(*whole), whole->primitives.size(), 0, 0},
              scenes::memory_bytes(*whole),
              nullptr};
  place.state = std::make_unique<PartState>(std::move(whole), job, transport);
  return place;
}

/// Returns whether process 0 needs the primitives that were hit.
bool needs_surfaces(const ClusterRequest& request) {
  if (request.job.light) return true;
  const bool is_of_hits =
      request.shading == render::Shading::kId || request.shading == render::Shading::kDepth;
  return !request.picture.empty() && !is_of_hits;
}

/// Finds the light of all samples of an image whose hits are known.
render::Image drawn_light(const ClusterRequest& request, Transport& transport,
                          const scenes::Scene& whole, const PartState& state,
                          const accel::HitBuffer& hits, SplitRun& run) {
  LightLeader leader(transport, *state.worker, state.split, request.producer.timeout);
  DrawnLight drawn = leader.draw(whole, request.job.whitted,
                                 rays::HitCheck(whole, beam_choice(request.job)), state.rays, hits);
  run.light = std::move(drawn.reports);
  run.light_seconds = drawn.seconds;
  run.census = drawn.census;
  return std::move(drawn.image);
}

Json to_json(const LightReport& report) {
  return {{"rays_out", report.rays_out},
          {"answers_out", report.answers_out},
          {"out", to_json(report.out)},
          {"rays_in", to_json(report.rays_in)},
          {"cpu_seconds", report.cpu_seconds}};
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
  std::shared_ptr<const scenes::Scene> whole;
  set_up_producer(transport, [&](std::vector<std::string>& warnings) {
    whole = load_whole(request.job, &warnings);
    auto read = needs_surfaces(request) ? whole : std::exchange(whole, nullptr);
    place = set_up(std::move(read), request.job, transport);
  });
  const auto check = [&](ProcessId process, std::span<const std::byte> ready_report) {
    read_ready_report(process, ready_report, place.identity);
  };
  SplitRun run;
  run.job = request.job;
  run.whole_scene_bytes = place.whole_bytes;
  run.shading_bytes = whole ? place.whole_bytes : 0;
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
  std::optional<render::Image> light;
  if (request.job.light) light = drawn_light(request, transport, *whole, state, hits, run);
  run.result_hash = light ? render::fingerprint(*light) : rays::fingerprint(hits);
  run.job.resolution = {rays.width(), rays.height()};
  if (!request.picture.empty()) {
    // The ids are those of the whole scene, of which each process has only a part.
    rays::HitCheck(run.whole_primitives, "structure 'beam'").require(hits, rays);
    render::write_image(
        request.picture,
        light ? *light
              : render::shade(whole ? *whole : state.worker->scene(), rays, hits, request.shading));
  }
  if (!request.report.empty()) write_file(request.report, json_text(to_json(run)) + "\n");
  return run;
}

void follow_split(const Job& job, Transport& transport) {
  const auto place =
      set_up_consumer(transport, [&] { return set_up(load_whole(job, nullptr), job, transport); });
  if (!place) return;
  transport.send(kProducer, Tag::kReady,
                 write_ready_report({host_name(), "", place->identity, 0.0, 0}));
  PartState& state = *place->state;
  PartMember member(transport, *state.worker, state.outbox, 5.0 * job.heartbeat_interval,
                    [](ProcessId, std::span<const std::byte>) {});
  member.follow([&] { return write_result(member.report(), *state.worker); });
  if (member.began() && job.light) {
    serve_light(transport, *state.worker, state.split, job.heartbeat_interval);
  }
}

nlohmann::ordered_json to_json(const SplitRun& run) {
  const measure::BuildInfo& build = measure::build_info();
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
            {"whole_scene_bytes", run.whole_scene_bytes},
            {"shading_bytes", run.shading_bytes}};
  if (!run.light.empty()) {
    json["light_seconds"] = run.light_seconds;
    json["rays"] = to_json(run.census);
  }
  Json& each = json["each"] = Json::array();
  for (const PartReport& report : run.reports) each.push_back(to_json(report));
  for (std::size_t i = 0; i < run.light.size(); ++i) each[i]["light"] = to_json(run.light[i]);
  return json;
}

namespace {

std::string summary_of_light(const SplitRun& run) {
  if (run.light.empty()) return "";
  Traffic out;
  std::uint64_t rays = 0;
  for (const LightReport& report : run.light) {
    out += report.out;
    rays += report.rays_out;
  }
  return fmt::format(
      "; light in {:.3f} s; its rays were passed on {} times, in {} messages with {:.2f} MB",
      run.light_seconds, rays, out.messages, 1e-6 * static_cast<double>(out.bytes));
}

}  // namespace

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
  std::string text = fmt::format(
      "{} processes in {:.3f} s; {} beams and {} rays were passed on in {} messages with {:.2f} "
      "MB; the largest part has {} of {} primitives and {:.2f} MB with its octree",
      run.reports.size(), run.seconds, beams, rays, crossings.messages,
      1e-6 * static_cast<double>(crossings.bytes), most, run.whole_primitives,
      1e-6 * static_cast<double>(largest));
  if (run.shading_bytes > 0) {
    text += fmt::format("; process 0 also keeps the whole scene for shading, {:.2f} MB",
                        1e-6 * static_cast<double>(run.shading_bytes));
  }
  return text + summary_of_light(run);
}

}  // namespace beambench::cluster
