#pragma once
// A process that traces its part of a divided scene.

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "harness/thesis/cluster/job.hpp"
#include "harness/thesis/cluster/report.hpp"
#include "harness/thesis/cluster/split/part_worker.hpp"
#include "harness/thesis/cluster/transport.hpp"
#include "scenes/base/error.hpp"

namespace beambench::cluster {

/// Thrown if a process is lost and will not reach MPI_Finalize.
class LostProcess : public InputError {
 public:
  using InputError::InputError;
};

/// Returns the error for a process that was silent for `timeout` seconds; no other process has its
/// part of the scene.
LostProcess silent_part(ProcessId process, double timeout);

/// The size of a process's part, and the work of the process.
struct PartReport {
  std::uint64_t primitives = 0;
  std::uint64_t scene_bytes = 0;
  std::uint64_t structure_bytes = 0;
  std::uint64_t beams_out = 0;
  std::uint64_t rays_out = 0;
  Traffic crossings_out;  ///< messages with beams and rays
  Traffic crossings_in;
  double cpu_seconds = 0.0;   ///< for tracing and for receiving handoffs
  double wait_seconds = 0.0;  ///< wall time waiting for messages
};

/// Sums over all processes, each taken when the process was idle.
struct Wave {
  std::uint64_t sent = 0;
  std::uint64_t received = 0;
  friend bool operator==(const Wave&, const Wave&) = default;
};

/// Traces until all processes are idle and no message is in transit. Process 0 detects this with
/// Mattern's four counters ("Algorithms for distributed termination detection", Distributed
/// Computing 2, 1987). It requests the numbers of handoff messages sent and received, and each
/// process replies when it is idle. The run is over when two rounds yield the same sums, with as
/// many messages sent as received.
///
/// Processes cannot be replaced: process 0 ends the run if one is silent.
class PartMember {
 public:
  using Check = std::function<void(ProcessId, std::span<const std::byte>)>;
  /// Called after each piece of work with its CPU time.
  using Meter = std::function<void(PartWork, double cpu_seconds)>;

  /// `timeout` is the silence in seconds after which process 0 throws LostProcess; for `check`, see
  /// Producer.
  PartMember(Transport& transport, PartWorker& worker, Outbox& outbox, double timeout, Check check,
             Meter meter = nullptr);

  /// Runs process 0: works to the end and returns the final reports of the other processes, by
  /// process. They are shut down even if an exception is thrown.
  std::vector<Bytes> lead();
  /// Runs any other process: works to the end and sends `result`.
  void follow(const std::function<Bytes()>& result);
  /// Returns whether the run has begun. It does not begin if process 0 finds that the processes do
  /// not match.
  bool began() const { return going_; }

  /// Returns the report so far.
  PartReport report() const;

 private:
  void wait_for_all();
  void run();
  void handle(const Message& message);
  void take_crossings(const Message& message);
  void done(PartWork work, double cpu_seconds);
  void take_count(const Message& message);
  void wait_idle();
  void begin_wave();
  void end_wave();
  void send_others(Tag tag);
  void send_heartbeat();
  void require_heartbeats();

  Transport* transport_;
  PartWorker* worker_;
  Outbox* outbox_;
  double timeout_;
  Check check_;
  Meter meter_;
  Traffic received_;
  double cpu_seconds_ = 0.0;
  double wait_seconds_ = 0.0;
  double last_sign_ = 0.0;  ///< last heartbeat sent
  bool going_ = false;
  bool asked_ = false;
  bool over_ = false;
  // On process 0:
  struct Other {
    bool answered = false;  ///< whether it has replied in this wave
    double last_heard = 0.0;
  };
  Other& other(ProcessId process) { return others_[static_cast<std::size_t>(process)]; }
  std::vector<Other> others_;
  std::vector<Bytes> results_;
  int missing_;  ///< number of processes that are not ready yet
  int missing_counts_ = 0;
  int missing_results_;
  bool in_wave_ = false;
  Wave wave_;
  std::optional<Wave> last_wave_;
};

/// A process's part of a scene, ready to be traced.
struct PartState {
  /// Frees the whole scene before building. Throws InputError for options that a divided scene does
  /// not support.
  PartState(std::shared_ptr<const scenes::Scene> whole, const Job& job, Transport& transport);

  accel::beam::BeamOptions options;
  accel::PrimaryRays rays;
  SceneSplit split;
  Outbox outbox;
  std::optional<PartWorker> worker;
};

/// Encodes a process's report and its hits.
Bytes write_result(const PartReport& report, const PartWorker& worker);
/// Adds the hits to those of other processes. Throws ProtocolError for other bytes.
PartReport take_result(std::span<const std::byte> result, accel::HitBuffer& hits);

}  // namespace beambench::cluster
