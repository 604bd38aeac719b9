#include "harness/cluster/split/split_studio.hpp"

#include <utility>

#include "harness/cli/inputs.hpp"
#include "harness/cluster/sample_results.hpp"

namespace beambench::cluster {

SplitStudio::SplitStudio(std::shared_ptr<const scenes::Scene> whole, const Job& job,
                         Transport& transport) {
  const accel::beam::BeamOptions options =
      accel::beam::BeamOptions::from(cli::choose_one("--accel", job.structure).parameters());
  const rays::ImageOfRays image = job_image(job, *whole);
  rays_.emplace(image.camera, image.resolution.width, image.resolution.height, image.samples);
  split_.emplace(*whole, options.octree, job.split_level, transport.processes());
  ScenePart part = part_of(*whole, *split_, transport.self());
  whole.reset();
  split_->forget_primitives();
  outbox_ = std::make_unique<Outbox>(transport, *split_);
  worker_ = std::make_unique<SplitWorker>(std::move(part), *split_, transport.self(), options,
                                          *rays_, *outbox_);
}

Bytes write_result(const SplitAccount& account, const SplitWorker& worker) {
  Bytes bytes;
  ByteWriter writer(bytes);
  write_account(account, writer);
  write_hits(worker.hit_samples(), worker.hits(), bytes);
  return bytes;
}

SplitAccount take_result(std::span<const std::byte> result, accel::HitBuffer& hits) {
  ByteReader reader(result);
  const SplitAccount account = read_split_account(reader);
  HitSink(hits).accept(reader.rest());
  return account;
}

}  // namespace beambench::cluster
