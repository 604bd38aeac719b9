#include "harness/thesis/cluster/producer.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "harness/base/stopwatch.hpp"
#include "harness/thesis/cluster/consumer.hpp"

namespace beambench::cluster {

Producer::Producer(Transport& transport, TaskSource& source, ResultSink& sink, TaskWorker& own,
                   Check check, const ProducerOptions& options)
    : transport_(&transport),
      source_(&source),
      sink_(&sink),
      own_(&own),
      check_(std::move(check)),
      options_(options),
      pool_(transport.processes(), options.in_flight, options.timeout) {
  report_.processes.resize(static_cast<std::size_t>(transport.processes()));
}

ClusterReport Producer::run() {
  try {
    begin_ = transport_->seconds();
    while (make_parcel()) hand_out(next_number_ - 1);
    report_.last_walk_seconds = walked_;
    finish();
  } catch (...) {
    shut_down_all();
    throw;
  }
  return std::move(report_);
}

/// Shuts consumers down after their last result. Performs lost tasks itself if no consumer is left.
void Producer::finish() {
  shut_down_idle();
  while (!open_.empty()) {
    give_lost();
    if (!lost_.empty() && pool_.nobody_present()) {
      const Number number = lost_.front();
      lost_.pop_front();
      do_here(number);
    } else {
      wait_for_message();
      if (lost_.empty()) shut_down_idle();
    }
  }
  report_.seconds = transport_->seconds() - begin_;
  shut_down_all();
  wait_for_final_reports();
  own_->write_counts(of(kProducer).counted);
}

/// Waits for all final reports, but no longer than the timeout.
void Producer::wait_for_final_reports() {
  const double last_call = transport_->seconds() + options_.timeout;
  const auto missing = [this] {
    std::vector<ProcessId> processes;
    for (ProcessId process = kProducer + 1; process < transport_->processes(); ++process) {
      if (!of(process).final_report_came) processes.push_back(process);
    }
    return processes;
  };
  while (!missing().empty()) {
    const auto message = transport_->wait(last_call - transport_->seconds());
    if (!message) break;
    handle(*message);
  }
  report_.lost = missing();
  for (const ProcessId process : report_.lost) {
    report_.remarks.push_back(
        fmt::format("process {} was silent for {} s at the end", process, options_.timeout));
  }
}

/// Opens a parcel with the next tasks; returns false if there are none.
bool Producer::make_parcel() {
  ParcelWriter parcel(next_number_);
  const std::size_t first = report_.tasks.size();
  const std::size_t planned = source_->parcel_size();
  const std::size_t most = planned > 0 ? planned : options_.batch;
  while (parcel.items() < most) {
    Bytes& bytes = parcel.begin_item();
    const std::size_t begin = bytes.size();
    const base::CpuStopwatch timer;
    const bool more = source_->next(bytes);
    const double seconds = timer.seconds();
    report_.walk_seconds += seconds;
    walked_ += seconds;
    if (!more) {
      parcel.drop_item();
      break;
    }
    TaskReport& task = report_.tasks.emplace_back();
    task.walk_seconds = std::exchange(walked_, 0.0);
    task.task_bytes = bytes.size() - begin;
    task.estimate_seconds = source_->estimate();
    parcel.end_item();
  }
  if (parcel.items() == 0) return false;
  open_.emplace(next_number_++, Parcel{std::move(parcel).take(), first, kProducer});
  return true;
}

void Producer::hand_out(Number number) {
  while (const auto message = transport_->poll()) handle(*message);
  give_lost();
  while (true) {
    if (const auto consumer = pool_.longest_waiting()) return give(number, *consumer);
    if (options_.consumes || must_work_alone()) return do_here(number);
    wait_for_message();
    give_lost();
  }
}

void Producer::give(Number number, ProcessId consumer) {
  Parcel& parcel = open_.at(number);
  parcel.holder = consumer;
  of(consumer).from_producer.add(parcel.bytes.size());
  transport_->send(consumer, Tag::kTasks, parcel.bytes);
  pool_.gave(consumer, transport_->seconds());
}

void Producer::give_lost() {
  while (!lost_.empty()) {
    const auto consumer = pool_.longest_waiting();
    if (!consumer) return;
    const Number number = lost_.front();
    lost_.pop_front();
    if (open_.contains(number)) give(number, *consumer);  // its results may have arrived after all
  }
}

void Producer::do_here(Number number) {
  const auto found = open_.find(number);
  if (found == open_.end()) return;
  const Parcel parcel = std::move(found->second);
  open_.erase(found);
  const ParcelReader reader(parcel.bytes);
  std::size_t task = parcel.first_task;
  Bytes result;
  for (const ParcelItem& item : reader.items()) {
    result.clear();
    const double before = transport_->seconds();
    const base::CpuStopwatch timer;
    own_->perform(item.bytes, result, [] {});
    const double seconds = timer.seconds();
    of(kProducer).busy_seconds += transport_->seconds() - before;
    of(kProducer).cpu_seconds += seconds;
    ++of(kProducer).tasks;
    take_result(task++, item.bytes, kProducer, {static_cast<float>(seconds), result});
  }
}

bool Producer::must_work_alone() const {
  if (!pool_.nobody_present()) return false;
  return transport_->processes() == 1 ||
         transport_->seconds() - begin_ >= options_.startup_timeout || !pool_.lost().empty();
}

void Producer::wait_for_message() {
  const double now = transport_->seconds();
  double deadline = pool_.next_deadline();
  if (pool_.nobody_present()) deadline = std::min(deadline, begin_ + options_.startup_timeout);
  const auto message = transport_->wait(std::max(0.0, deadline - now));
  report_.producer_wait_seconds += transport_->seconds() - now;
  if (message) handle(*message);
  declare_silent_lost();
}

void Producer::handle(const Message& message) {
  of(message.from).to_producer.add(message.bytes.size());
  const double now = transport_->seconds();
  switch (message.tag) {
    case Tag::kReady:
      check_(message.from, message.bytes);
      pool_.join(message.from, now);
      break;
    case Tag::kResults:
      take_results(message);
      pool_.returned(message.from, now);
      break;
    case Tag::kFinalReport:
      of(message.from).final_report_came = true;
      read_report(message.bytes, of(message.from));
      break;
    case Tag::kHeartbeat:
      pool_.heard(message.from, now);
      break;
    default:
      throw ProtocolError(
          fmt::format("process {} sent a message that consumers do not send", message.from));
  }
}

void Producer::take_results(const Message& message) {
  const ParcelReader reader(message.bytes);
  const auto found = open_.find(reader.number());
  if (found == open_.end()) return;  // another process was faster
  const Parcel parcel = std::move(found->second);
  open_.erase(found);
  const ParcelReader tasks(parcel.bytes);
  if (tasks.items().size() != reader.items().size()) {
    throw ProtocolError(
        fmt::format("process {} sent more or fewer results than it had tasks", message.from));
  }
  for (std::size_t i = 0; i < reader.items().size(); ++i) {
    take_result(parcel.first_task + i, tasks.items()[i].bytes, message.from, reader.items()[i]);
  }
}

void Producer::take_result(std::size_t number, std::span<const std::byte> task, ProcessId from,
                           const ParcelItem& result) {
  const base::CpuStopwatch timer;
  const std::size_t samples = sink_->accept(result.bytes);
  if (options_.keep) options_.keep(task, result.bytes);
  TaskReport& row = report_.tasks.at(number);
  row.accept_seconds = timer.seconds();
  row.process = from;
  row.work_seconds = result.note;
  row.samples = samples;
  row.result_bytes = result.bytes.size();
  report_.accept_seconds += row.accept_seconds;
  of(from).samples += samples;
  of(from).last_result = transport_->seconds() - begin_;
}

void Producer::declare_silent_lost() {
  for (const ProcessId consumer : pool_.declare_silent_lost(transport_->seconds())) {
    std::size_t count = 0;
    for (const auto& [number, parcel] : open_) {
      if (parcel.holder != consumer) continue;
      lost_.push_back(number);
      ++count;
    }
    report_.remarks.push_back(
        fmt::format("process {} was silent for {} s and was declared lost; its {} messages were "
                    "given to others",
                    consumer, options_.timeout, count));
  }
}

void Producer::shut_down(ProcessId consumer) {
  of(consumer).from_producer.add(0);
  transport_->send(consumer, Tag::kEnd, {});
  pool_.shut_down(consumer);
}

void Producer::shut_down_idle() {
  for (const ProcessId consumer : pool_.present()) {
    if (pool_.idle(consumer)) shut_down(consumer);
  }
}

/// Also shuts down consumers that never joined or were declared lost, in case they still receive
/// the message.
void Producer::shut_down_all() {
  for (const ProcessId consumer : pool_.not_shut_down()) shut_down(consumer);
}

}  // namespace beambench::cluster
