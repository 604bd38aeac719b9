#include "harness/cluster/consumer.hpp"

#include <utility>

#include <fmt/format.h>

#include "harness/base/stopwatch.hpp"
#include "harness/cluster/messages.hpp"

namespace beambench::cluster {

Bytes write_report(const ConsumerReport& report) {
  Bytes bytes;
  ByteWriter writer(bytes);
  writer.put(report.tasks);
  writer.put(report.busy_seconds);
  writer.put(report.cpu_seconds);
  writer.put(report.wait_seconds);
  writer.put_bytes(report.counted);
  return bytes;
}

ConsumerReport read_consumer_report(std::span<const std::byte> bytes) {
  ByteReader reader(bytes);
  ConsumerReport report;
  report.tasks = reader.get<std::uint64_t>();
  report.busy_seconds = reader.get<double>();
  report.cpu_seconds = reader.get<double>();
  report.wait_seconds = reader.get<double>();
  const auto counted = reader.rest();
  report.counted.assign(counted.begin(), counted.end());
  return report;
}

void Consumer::run(Bytes ready_report) {
  send(Tag::kReady, std::move(ready_report));
  while (true) {
    const double before = transport_->seconds();
    const auto message = transport_->wait(Transport::kForever);
    report_.wait_seconds += transport_->seconds() - before;
    if (!message) continue;
    if (message->tag == Tag::kEnd) break;
    if (message->tag != Tag::kTasks)
      throw ProtocolError("a consumer received a message for the producer");
    do_parcel(*message);
  }
  worker_->write_counts(report_.counted);
  send(Tag::kFinalReport, write_report(report_));
}

void Consumer::do_parcel(const Message& message) {
  const ParcelReader tasks(message.bytes);
  ParcelWriter results(tasks.number());
  const auto heartbeat = [this] {
    if (transport_->seconds() - last_sent_ < heartbeat_interval_) return;
    transport_->send(kProducer, Tag::kHeartbeat, {});
    last_sent_ = transport_->seconds();
  };
  last_sent_ = transport_->seconds();
  for (const ParcelItem& task : tasks.items()) {
    const double before = transport_->seconds();
    const base::CpuStopwatch timer;
    worker_->perform(task.bytes, results.begin_item(), heartbeat);
    const double seconds = timer.seconds();
    results.end_item(static_cast<float>(seconds));
    ++report_.tasks;
    report_.cpu_seconds += seconds;
    report_.busy_seconds += transport_->seconds() - before;
    heartbeat();
  }
  send(Tag::kResults, std::move(results).take());
}

/// Waits until the message has left, as MPI_Send does.
void Consumer::send(Tag tag, Bytes bytes) {
  transport_->send(kProducer, tag, std::move(bytes));
  transport_->flush();
  last_sent_ = transport_->seconds();
}

}  // namespace beambench::cluster
