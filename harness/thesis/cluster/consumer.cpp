#include "harness/thesis/cluster/consumer.hpp"

#include <concepts>
#include <tuple>
#include <type_traits>
#include <utility>

#include "harness/base/stopwatch.hpp"
#include "harness/thesis/cluster/messages.hpp"

namespace beambench::cluster {
namespace {

template <class Report>
auto members(Report& report) requires std::same_as<std::remove_const_t<Report>, ProcessReport> {
  return std::tie(report.tasks, report.busy_seconds, report.cpu_seconds, report.wait_seconds);
}

}  // namespace

Bytes write_report(const ProcessReport& report) {
  Bytes bytes;
  ByteWriter writer(bytes);
  writer.put(members(report));
  writer.put_bytes(report.counted);
  return bytes;
}

void read_report(std::span<const std::byte> bytes, ProcessReport& report) {
  ByteReader reader(bytes);
  reader.get(members(report));
  const auto counted = reader.rest();
  report.counted.assign(counted.begin(), counted.end());
}

void consume(Transport& transport, TaskWorker& worker, double heartbeat_interval,
             Bytes ready_report) {
  ProcessReport report;
  double last_sent = 0.0;
  /// Sends a message and waits until it has left, as MPI_Send does.
  const auto send = [&](Tag tag, Bytes bytes) {
    transport.send(kProducer, tag, std::move(bytes));
    transport.flush();
    last_sent = transport.seconds();
  };
  const Heartbeat heartbeat = [&] {
    if (transport.seconds() - last_sent < heartbeat_interval) return;
    transport.send(kProducer, Tag::kHeartbeat, {});
    last_sent = transport.seconds();
  };
  send(Tag::kReady, std::move(ready_report));
  while (true) {
    double before = transport.seconds();
    const auto message = transport.wait(Transport::kForever);
    report.wait_seconds += transport.seconds() - before;
    if (!message) continue;
    if (message->tag == Tag::kEnd) break;
    if (message->tag != Tag::kTasks)
      throw ProtocolError("a consumer received a message for the producer");
    const ParcelReader tasks(message->bytes);
    ParcelWriter results(tasks.number());
    last_sent = transport.seconds();
    for (const ParcelItem& task : tasks.items()) {
      before = transport.seconds();
      const base::CpuStopwatch timer;
      worker.perform(task.bytes, results.begin_item(), heartbeat);
      const double seconds = timer.seconds();
      results.end_item(static_cast<float>(seconds));
      ++report.tasks;
      report.cpu_seconds += seconds;
      report.busy_seconds += transport.seconds() - before;
      heartbeat();
    }
    send(Tag::kResults, std::move(results).take());
  }
  worker.write_counts(report.counted);
  send(Tag::kFinalReport, write_report(report));
}

}  // namespace beambench::cluster
