#pragma once
// The process that performs the producer's tasks.

#include <cstdint>
#include <span>

#include "harness/cluster/roles.hpp"
#include "harness/cluster/transport.hpp"

namespace beambench::cluster {

/// A consumer's final report.
struct ConsumerReport {
  std::uint64_t tasks = 0;
  double busy_seconds = 0.0;
  double cpu_seconds = 0.0;
  double wait_seconds = 0.0;
  Bytes counted;  ///< `TaskWorker::write_counts`
};

/// As bytes, and back. Reading throws ProtocolError for other bytes.
Bytes write_report(const ConsumerReport& report);
ConsumerReport read_consumer_report(std::span<const std::byte> bytes);

/// A consumer of section 6.2: waits for a parcel, performs its tasks, sends the results, until the
/// end message. In a long task it sends heartbeats.
class Consumer {
 public:
  /// `heartbeat_interval`: seconds between two heartbeats.
  Consumer(Transport& transport, TaskWorker& worker, double heartbeat_interval)
      : transport_(&transport), worker_(&worker), heartbeat_interval_(heartbeat_interval) {}

  /// `ready_report`: its first message.
  void run(Bytes ready_report);

 private:
  void do_parcel(const Message& message);
  void send(Tag tag, Bytes bytes);

  Transport* transport_;
  TaskWorker* worker_;
  double heartbeat_interval_;
  double last_sent_ = 0.0;
  ConsumerReport report_;
};

}  // namespace beambench::cluster
