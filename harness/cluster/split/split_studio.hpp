#pragma once
// What a process of a divided scene makes for itself, and what it sends at the end.

#include <memory>
#include <optional>
#include <span>

#include "harness/cluster/job.hpp"
#include "harness/cluster/split/split_member.hpp"

namespace beambench::cluster {

/// A process's part of a scene, ready to be traced.
class SplitStudio {
 public:
  /// Lets go of the whole scene before it builds. Throws InputError for what the job cannot be done
  /// with.
  SplitStudio(std::shared_ptr<const scenes::Scene> whole, const Job& job, Transport& transport);

  const accel::PrimaryRays& rays() const { return *rays_; }
  SplitWorker& worker() { return *worker_; }
  Outbox& outbox() { return *outbox_; }

 private:
  std::optional<accel::PrimaryRays> rays_;
  std::optional<SceneSplit> split_;
  std::unique_ptr<Outbox> outbox_;
  std::unique_ptr<SplitWorker> worker_;
};

/// What a process did, and what was found there.
Bytes write_result(const SplitAccount& account, const SplitWorker& worker);
/// Puts that to the others' hits. Throws ProtocolError for what it is not.
SplitAccount take_result(std::span<const std::byte> result, accel::HitBuffer& hits);

}  // namespace beambench::cluster
