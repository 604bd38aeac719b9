#pragma once
// The process that does what the producer gives it.

#include <cstdint>
#include <span>

#include "harness/cluster/roles.hpp"
#include "harness/cluster/transport.hpp"

namespace beambench::cluster {

/// What a consumer tells at its end.
struct ConsumerAccount {
  std::uint64_t tasks = 0;
  double busy_seconds = 0.0;
  double cpu_seconds = 0.0;
  double wait_seconds = 0.0;
  Bytes counted;  ///< `TaskWorker::tell`
};

/// As bytes, and back. Reading throws ProtocolError where it is none.
Bytes write_account(const ConsumerAccount& account);
ConsumerAccount read_account(std::span<const std::byte> bytes);

/// A consumer of section 6.2: waits for a parcel, does its tasks, sends the results, until it is
/// told that there is no more. In a long task it tells the producer that it is alive.
class Consumer {
 public:
  /// `alive_every`: seconds between two signs of life.
  Consumer(Transport& transport, TaskWorker& worker, double alive_every)
      : transport_(&transport), worker_(&worker), alive_every_(alive_every) {}

  /// `introduction`: what it says of itself when it is ready.
  void run(Bytes introduction);

 private:
  void do_parcel(const Message& message);
  void send(Tag tag, Bytes bytes);

  Transport* transport_;
  TaskWorker* worker_;
  double alive_every_;
  double last_sent_ = 0.0;
  ConsumerAccount account_;
};

}  // namespace beambench::cluster
