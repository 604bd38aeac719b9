#pragma once
// A process with its part of a divided scene, among others with theirs.

#include <functional>
#include <vector>

#include "harness/cluster/process_report.hpp"
#include "harness/cluster/split/split_worker.hpp"
#include "harness/cluster/transport.hpp"
#include "scenes/core/error.hpp"

namespace beambench::cluster {

/// A process is not there any more, and will not come to MPI's end, either.
class LostProcess : public InputError {
 public:
  using InputError::InputError;
};

/// What a process had and did.
struct SplitAccount {
  std::uint64_t primitives = 0;
  std::uint64_t scene_bytes = 0;
  std::uint64_t structure_bytes = 0;
  std::uint64_t beams_out = 0;
  std::uint64_t rays_out = 0;
  Traffic crossings_out;  ///< messages with beams and rays
  Traffic crossings_in;
  double cpu_seconds = 0.0;   ///< in tracing, and in taking what others handed over
  double wait_seconds = 0.0;  ///< for messages, wall time
};
void write_account(const SplitAccount& account, ByteWriter& writer);
SplitAccount read_split_account(ByteReader& reader);

/// Collects what crosses borders into messages, one at a time for each process.
class Outbox : public BorderPost {
 public:
  Outbox(Transport& transport, const SceneSplit& split);
  void hand_over(const CrossingBeam& beam) override;
  void hand_over(const CrossingRay& ray) override;

  /// Sends what is large enough to be worth a message; all of it.
  void send_large();
  void send_all();

  const Traffic& sent() const { return sent_; }
  std::uint64_t beams() const { return beams_; }
  std::uint64_t rays() const { return rays_; }

 private:
  void send(std::size_t process);

  Transport* transport_;
  const SceneSplit* split_;
  std::vector<Bytes> open_;  ///< by process
  Traffic sent_;
  std::uint64_t beams_ = 0;
  std::uint64_t rays_ = 0;
};

/// Sums over all processes, at times when each had nothing to do.
struct Wave {
  std::uint64_t sent = 0;
  std::uint64_t received = 0;
};

/// Traces until no process has anything to do and no message is on its way. Process 0 finds that
/// out by Mattern's four counters ("Algorithms for distributed termination detection", Distributed
/// Computing 2, 1987): it asks all how many crossings they sent and received, each answers when it
/// has nothing to do, and when two rounds give the same sums, sent equal to received, it is over.
///
/// No process has another's part, so none can be done without: process 0 ends the run where one is
/// silent.
class SplitMember {
 public:
  using Check = std::function<void(ProcessId, std::span<const std::byte>)>;
  /// Is told what processor time each piece of work took, when it is done.
  using Meter = std::function<void(SplitWork, double cpu_seconds)>;

  /// `timeout`: seconds of silence after which process 0 throws LostProcess; `check` is told what
  /// others say of themselves and throws InputError (see Producer).
  SplitMember(Transport& transport, SplitWorker& worker, Outbox& outbox, double timeout,
              Check check, Meter meter = nullptr);

  /// On process 0: what the others sent at the end, by process. It sends all home, whatever it
  /// throws.
  std::vector<Bytes> lead();
  /// On the others: to the end, at which `result` is sent.
  void follow(const std::function<Bytes()>& result);

  /// So far.
  SplitAccount account() const;

 private:
  void wait_for_all();
  void run();
  void handle(const Message& message);
  void take_crossings(const Message& message);
  void done(SplitWork work, double cpu_seconds);
  void take_count(const Message& message);
  void have_nothing_to_do();
  void answer();
  void begin_wave();
  void end_wave();
  void send_others(Tag tag);
  void give_sign_of_life();
  void require_signs_of_life();

  Transport* transport_;
  SplitWorker* worker_;
  Outbox* outbox_;
  double timeout_;
  Check check_;
  Meter meter_;
  Traffic received_;
  double cpu_seconds_ = 0.0;
  double wait_seconds_ = 0.0;
  double last_sign_ = 0.0;  ///< of our own life
  bool going_ = false;
  bool asked_ = false;
  bool over_ = false;
  // Of process 0:
  struct Other {
    bool answered = false;  ///< this wave
    double last_heard = 0.0;
  };
  Other& other(ProcessId process) { return others_[static_cast<std::size_t>(process)]; }
  std::vector<Other> others_;
  std::vector<Bytes> results_;
  int missing_;  ///< who are not ready yet
  int missing_counts_ = 0;
  int missing_results_;
  bool in_wave_ = false;
  Wave wave_;
  std::optional<Wave> last_wave_;
};

}  // namespace beambench::cluster
