#include "harness/cluster/split/split_run.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <new>
#include <optional>

#include <fmt/format.h>

#include "harness/cli/inputs.hpp"
#include "harness/cluster/lead.hpp"
#include "harness/cluster/sample_results.hpp"
#include "harness/cluster/studio.hpp"
#include "harness/files/pending_file.hpp"
#include "harness/picture/image_file.hpp"
#include "harness/rays/fingerprint.hpp"
#include "harness/record/build_info.hpp"
#include "scenes/catalogue.hpp"

namespace beambench {
namespace {

using Json = nlohmann::ordered_json;

/// What a process makes for itself of a job: its part, ready to be traced.
class Workplace {
 public:
  Workplace(const Job& job, Transport& transport, std::vector<std::string>* warnings) {
    ScenePart part;
    {
      const Scene whole = load_scene(job.scene, warnings);
      identity_ = {look_hash(whole), whole.primitives.size(), 0};
      whole_bytes_ = memory_bytes(whole);
      options_ = BeamOptions::from(choose_one("--accel", job.structure).parameters());
      const ImageOfRays image = job_image(job, whole);
      rays_.emplace(image.camera, image.resolution.width, image.resolution.height, image.samples);
      split_.emplace(whole, options_.octree, job.split_level, transport.processes());
      part = part_of(whole, *split_, transport.self());
    }
    outbox_ = std::make_unique<Outbox>(transport, *split_);
    worker_ = std::make_unique<SplitWorker>(std::move(part), *split_, transport.self(), options_,
                                            *rays_, *outbox_);
    split_->forget_primitives();
  }

  const Identity& identity() const { return identity_; }
  std::uint64_t whole_bytes() const { return whole_bytes_; }
  const PrimaryRays& rays() const { return *rays_; }
  SplitWorker& worker() { return *worker_; }
  Outbox& outbox() { return *outbox_; }

 private:
  Identity identity_;
  std::uint64_t whole_bytes_ = 0;
  BeamOptions options_;
  std::optional<PrimaryRays> rays_;
  std::optional<SceneSplit> split_;
  std::unique_ptr<Outbox> outbox_;
  std::unique_ptr<SplitWorker> worker_;
};

Bytes result_of(Workplace& place, const SplitMember& member) {
  Bytes bytes;
  ByteWriter writer(bytes);
  write_account(member.account(), writer);
  const std::vector<std::uint32_t> samples = place.worker().hit_samples();
  write_hits(samples, place.worker().hits(), bytes);
  return bytes;
}

SplitAccount take_result(std::span<const std::byte> result, HitBuffer& hits) {
  ByteReader reader(result);
  const SplitAccount account = read_split_account(reader);
  HitSink(hits).accept(reader.rest());
  return account;
}

Bytes introduce(const Identity& identity, const std::string& problem) {
  Introduction introduction;
  introduction.host = host_name();
  introduction.problem = problem;
  introduction.identity = identity;
  return write_introduction(introduction);
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
  std::optional<Workplace> place;
  std::vector<std::string> warnings;
  try {
    place.emplace(request.job, transport, &warnings);
  } catch (...) {
    send_all_home(transport);
    throw;
  }
  for (const std::string& warning : warnings)
    fmt::print(stderr, "beambench-cluster: {}\n", warning);
  const auto check = [&](ProcessId process, std::span<const std::byte> introduction) {
    read_introduction(process, introduction, place->identity());
  };
  SplitRun run;
  run.job = request.job;
  run.whole_scene_bytes = place->whole_bytes();
  run.whole_primitives = place->identity().nodes;
  const double begin = transport.seconds();
  SplitMember member(transport, place->worker(), place->outbox(), request.producer.timeout, check);
  std::vector<Bytes> results = member.lead();
  results[kProducer] = result_of(*place, member);
  const PrimaryRays& rays = place->rays();
  HitBuffer hits(rays.width(), rays.height(), rays.samples());
  for (const Bytes& result : results) run.accounts.push_back(take_result(result, hits));
  run.seconds = transport.seconds() - begin;
  run.result_hash = fingerprint(hits);
  run.job.width = rays.width();
  run.job.height = rays.height();
  if (!request.picture.empty()) {
    write_image(request.picture, shade(place->worker().scene(), rays, hits, request.shading));
  }
  if (!request.report.empty()) write_file(request.report, to_json(run).dump(2) + "\n");
  return run;
}

void follow_split(const Job& job, Transport& transport) {
  std::optional<Workplace> place;
  std::string problem;
  try {
    place.emplace(job, transport, nullptr);
  } catch (const InputError& error) {
    problem = error.what();
  } catch (const std::bad_alloc&) {
    problem = "the memory does not suffice for this scene";
  }
  transport.send(kProducer, Tag::kReady,
                 introduce(place ? place->identity() : Identity{}, problem));
  if (!place) {
    wait_for_end(transport);
    return;
  }
  SplitMember member(transport, place->worker(), place->outbox(), 5.0 * job.alive_every,
                     [](ProcessId, std::span<const std::byte>) {});
  member.follow([&] { return result_of(*place, member); });
}

nlohmann::ordered_json to_json(const SplitRun& run) {
  const BuildInfo& build = build_info();
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

}  // namespace beambench
