#include "harness/cluster/split/split_run.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "harness/bench/record/build_info.hpp"
#include "harness/cluster/set_up.hpp"
#include "harness/cluster/split/split_studio.hpp"
#include "harness/cluster/studio.hpp"
#include "harness/rays/fingerprint.hpp"
#include "harness/rays/hit_check.hpp"
#include "harness/render/picture/image_file.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/core/files.hpp"

namespace beambench::cluster {
namespace {

using Json = nlohmann::ordered_json;

/// A process's part, and what it says of the whole.
struct Workplace {
  Identity identity;
  std::uint64_t whole_bytes = 0;
  std::unique_ptr<SplitStudio> studio;
};

Workplace set_up(const Job& job, Transport& transport, std::vector<std::string>* warnings) {
  auto whole = std::make_shared<const scenes::Scene>(scenes::load_scene(job.scene, warnings));
  Workplace place{
      {look_hash(*whole), whole->primitives.size(), 0}, scenes::memory_bytes(*whole), nullptr};
  place.studio = std::make_unique<SplitStudio>(std::move(whole), job, transport);
  return place;
}

Json to_json(const Traffic& traffic) {
  return {{"messages", traffic.messages}, {"bytes", traffic.bytes}};
}

Json to_json(const SplitAccount& account) {
  return {{"primitives", account.primitives},
          {"scene_bytes", account.scene_bytes},
          {"structure_bytes", account.structure_bytes},
          {"beams_out", account.beams_out},
          {"rays_out", account.rays_out},
          {"crossings_out", to_json(account.crossings_out)},
          {"crossings_in", to_json(account.crossings_in)},
          {"cpu_seconds", account.cpu_seconds},
          {"wait_seconds", account.wait_seconds}};
}

}  // namespace

SplitRun lead_split(const ClusterRequest& request, Transport& transport) {
  Workplace place;
  set_up_to_lead(transport, [&](std::vector<std::string>& warnings) {
    place = set_up(request.job, transport, &warnings);
  });
  const auto check = [&](ProcessId process, std::span<const std::byte> introduction) {
    read_introduction(process, introduction, place.identity);
  };
  SplitRun run;
  run.job = request.job;
  run.whole_scene_bytes = place.whole_bytes;
  run.whole_primitives = place.identity.nodes;
  const double begin = transport.seconds();
  SplitStudio& studio = *place.studio;
  SplitMember member(transport, studio.worker(), studio.outbox(), request.producer.timeout, check);
  std::vector<Bytes> results = member.lead();
  results[kProducer] = write_result(member.account(), studio.worker());
  const accel::PrimaryRays& rays = studio.rays();
  accel::HitBuffer hits(rays.width(), rays.height(), rays.samples());
  for (const Bytes& result : results) run.accounts.push_back(take_result(result, hits));
  run.seconds = transport.seconds() - begin;
  run.result_hash = rays::fingerprint(hits);
  run.job.width = rays.width();
  run.job.height = rays.height();
  if (!request.picture.empty()) {
    // The ids are those of the whole scene, of which each process has a part.
    rays::HitCheck(run.whole_primitives, "structure 'beam'").require(hits, rays);
    render::write_image(request.picture,
                        render::shade(studio.worker().scene(), rays, hits, request.shading));
  }
  if (!request.report.empty()) write_file(request.report, to_json(run).dump(2) + "\n");
  return run;
}

void follow_split(const Job& job, Transport& transport) {
  const auto place = set_up_to_follow(transport, [&] { return set_up(job, transport, nullptr); });
  if (!place) return;
  Introduction introduction;
  introduction.host = host_name();
  introduction.identity = place->identity;
  transport.send(kProducer, Tag::kReady, write_introduction(introduction));
  SplitWorker& worker = place->studio->worker();
  SplitMember member(transport, worker, place->studio->outbox(), 5.0 * job.alive_every,
                     [](ProcessId, std::span<const std::byte>) {});
  member.follow([&] { return write_result(member.account(), worker); });
}

nlohmann::ordered_json to_json(const SplitRun& run) {
  const bench::BuildInfo& build = bench::build_info();
  Json json{{"version", build.version},
            {"commit", build.commit},
            {"dirty", build.dirty},
            {"scene", run.job.scene},
            {"structure", run.job.structure},
            {"width", run.job.width},
            {"height", run.job.height},
            {"samples", run.job.samples},
            {"work", "parts"},
            {"cells_level", run.job.split_level},
            {"processes", run.accounts.size()},
            {"seconds", run.seconds},
            {"result_hash", fmt::format("{:016x}", run.result_hash)},
            {"whole_primitives", run.whole_primitives},
            {"whole_scene_bytes", run.whole_scene_bytes}};
  Json& each = json["each"] = Json::array();
  for (const SplitAccount& account : run.accounts) each.push_back(to_json(account));
  return json;
}

std::string summary(const SplitRun& run) {
  Traffic crossings;
  std::uint64_t beams = 0;
  std::uint64_t rays = 0;
  std::uint64_t most = 0;
  std::uint64_t largest = 0;
  for (const SplitAccount& account : run.accounts) {
    crossings.messages += account.crossings_out.messages;
    crossings.bytes += account.crossings_out.bytes;
    beams += account.beams_out;
    rays += account.rays_out;
    most = std::max(most, account.primitives);
    largest = std::max(largest, account.scene_bytes + account.structure_bytes);
  }
  return fmt::format(
      "{} processes in {:.3f} s; {} beams and {} rays crossed borders, in {} messages with {:.2f} "
      "MB; the largest part has {} of {} primitives and {:.2f} MB with its octree",
      run.accounts.size(), run.seconds, beams, rays, crossings.messages,
      1e-6 * static_cast<double>(crossings.bytes), most, run.whole_primitives,
      1e-6 * static_cast<double>(largest));
}

}  // namespace beambench::cluster
