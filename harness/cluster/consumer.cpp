#include "harness/cluster/consumer.hpp"

#include <utility>

#include <fmt/format.h>

#include "harness/base/stopwatch.hpp"
#include "harness/cluster/parcel.hpp"

namespace beambench::cluster {

Bytes write_account(const ConsumerAccount& account) {
  Bytes bytes;
  ByteWriter writer(bytes);
  writer.put(account.tasks);
  writer.put(account.busy_seconds);
  writer.put(account.cpu_seconds);
  writer.put(account.wait_seconds);
  writer.put_bytes(account.counted);
  return bytes;
}

ConsumerAccount read_account(std::span<const std::byte> bytes) {
  ByteReader reader(bytes);
  ConsumerAccount account;
  account.tasks = reader.get<std::uint64_t>();
  account.busy_seconds = reader.get<double>();
  account.cpu_seconds = reader.get<double>();
  account.wait_seconds = reader.get<double>();
  const auto counted = reader.rest();
  account.counted.assign(counted.begin(), counted.end());
  return account;
}

void Consumer::run(Bytes introduction) {
  send(Tag::kReady, std::move(introduction));
  while (true) {
    const double before = transport_->seconds();
    const auto message = transport_->wait(Transport::kForever);
    account_.wait_seconds += transport_->seconds() - before;
    if (!message) continue;
    if (message->tag == Tag::kEnd) break;
    if (message->tag != Tag::kTasks) throw ProtocolError("a consumer got a consumer's message");
    do_parcel(*message);
  }
  worker_->tell(account_.counted);
  send(Tag::kFarewell, write_account(account_));
}

void Consumer::do_parcel(const Message& message) {
  const ParcelReader tasks(message.bytes);
  ParcelWriter results(tasks.number());
  const auto pulse = [this] {
    if (transport_->seconds() - last_sent_ < alive_every_) return;
    transport_->send(kProducer, Tag::kAlive, {});
    last_sent_ = transport_->seconds();
  };
  last_sent_ = transport_->seconds();
  for (const ParcelItem& task : tasks.items()) {
    const double before = transport_->seconds();
    const base::CpuStopwatch timer;
    worker_->perform(task.bytes, results.begin_item(), pulse);
    const double seconds = timer.seconds();
    results.end_item(static_cast<float>(seconds));
    ++account_.tasks;
    account_.cpu_seconds += seconds;
    account_.busy_seconds += transport_->seconds() - before;
    pulse();
  }
  send(Tag::kResults, std::move(results).take());
}

/// As MPI_Send does, it waits until the message has left.
void Consumer::send(Tag tag, Bytes bytes) {
  transport_->send(kProducer, tag, std::move(bytes));
  transport_->flush();
  last_sent_ = transport_->seconds();
}

}  // namespace beambench::cluster
