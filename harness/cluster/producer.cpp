#include "harness/cluster/producer.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "harness/base/stopwatch.hpp"
#include "harness/cluster/consumer.hpp"

namespace beambench::cluster {

Producer::Producer(Transport& transport, TaskSource& source, ResultSink& sink, TaskWorker& own,
                   Check check, const ProducerOptions& options)
    : transport_(&transport),
      source_(&source),
      sink_(&sink),
      own_(&own),
      check_(std::move(check)),
      options_(options),
      crew_(transport.processes(), options.in_flight, options.timeout) {
  report_.processes.resize(static_cast<std::size_t>(transport.processes()));
}

ClusterReport Producer::run() {
  try {
    begin_ = transport_->seconds();
    produce();
    finish();
  } catch (...) {
    dismiss_all();
    throw;
  }
  return std::move(report_);
}

void Producer::produce() {
  while (make_parcel()) hand_out(next_number_ - 1);
  report_.last_walk_seconds = walked_;
}

/// Consumers get the end with their last result; what they lose is done here.
void Producer::finish() {
  dismiss_idle();
  while (!open_.empty()) {
    give_lost();
    if (!lost_.empty() && crew_.nobody_present()) {
      const Number number = lost_.front();
      lost_.pop_front();
      do_here(number);
    } else {
      wait_for_message();
      if (lost_.empty()) dismiss_idle();
    }
  }
  report_.seconds = transport_->seconds() - begin_;
  dismiss_all();
  take_leave();
  own_->tell(of(kProducer).counted);
}

/// Waits for the farewells of all, but not for ever: one that hangs would not be heard.
void Producer::take_leave() {
  const double last_call = transport_->seconds() + options_.timeout;
  const auto missing = [this] {
    std::vector<ProcessId> processes;
    for (ProcessId process = kProducer + 1; process < transport_->processes(); ++process) {
      if (!of(process).said_farewell) processes.push_back(process);
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
        fmt::format("process {} said nothing for {} s at the end", process, options_.timeout));
  }
}

/// The next tasks as an open parcel; false when there are none.
bool Producer::make_parcel() {
  ParcelWriter parcel(next_number_);
  const std::size_t first = report_.tasks.size();
  while (parcel.items() < options_.batch) {
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
    parcel.end_item();
  }
  if (parcel.items() == 0) return false;
  open_.emplace(next_number_++, Parcel{std::move(parcel).take(), first, kProducer});
  return true;
}

void Producer::hand_out(Number number) {
  take_in_what_came();
  give_lost();
  while (true) {
    if (const auto consumer = crew_.longest_waiting()) return give(number, *consumer);
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
  crew_.gave(consumer, transport_->seconds());
}

void Producer::give_lost() {
  while (!lost_.empty()) {
    const auto consumer = crew_.longest_waiting();
    if (!consumer) return;
    const Number number = lost_.front();
    lost_.pop_front();
    if (open_.contains(number)) give(number, *consumer);  // or its results came after all
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
    take_result(task++, kProducer, {static_cast<float>(seconds), result});
  }
}

bool Producer::must_work_alone() const {
  if (!crew_.nobody_present()) return false;
  return transport_->processes() == 1 || transport_->seconds() - begin_ >= options_.patience ||
         !crew_.lost().empty();
}

void Producer::take_in_what_came() {
  while (const auto message = transport_->poll()) handle(*message);
}

void Producer::wait_for_message() {
  const double now = transport_->seconds();
  double deadline = crew_.next_deadline();
  if (crew_.nobody_present()) deadline = std::min(deadline, begin_ + options_.patience);
  const auto message = transport_->wait(std::max(0.0, deadline - now));
  report_.producer_wait_seconds += transport_->seconds() - now;
  if (message) handle(*message);
  give_up_silent();
}

void Producer::handle(const Message& message) {
  of(message.from).to_producer.add(message.bytes.size());
  const double now = transport_->seconds();
  switch (message.tag) {
    case Tag::kReady:
      check_(message.from, message.bytes);
      crew_.join(message.from, now);
      break;
    case Tag::kResults:
      take_results(message);
      crew_.returned(message.from, now);
      break;
    case Tag::kFarewell:
      take_farewell(message);
      break;
    case Tag::kAlive:
      crew_.heard(message.from, now);
      break;
    default:
      throw ProtocolError(fmt::format("process {} sent what no consumer sends", message.from));
  }
}

void Producer::take_results(const Message& message) {
  const ParcelReader reader(message.bytes);
  const auto found = open_.find(reader.number());
  if (found == open_.end()) return;  // others were asked for it meanwhile, and were faster
  std::size_t task = found->second.first_task;
  open_.erase(found);
  for (const ParcelItem& item : reader.items()) take_result(task++, message.from, item);
}

void Producer::take_result(std::size_t task, ProcessId from, const ParcelItem& result) {
  const base::CpuStopwatch timer;
  const std::size_t samples = sink_->accept(result.bytes);
  TaskReport& row = report_.tasks.at(task);
  row.accept_seconds = timer.seconds();
  row.process = from;
  row.work_seconds = result.note;
  row.samples = samples;
  row.result_bytes = result.bytes.size();
  report_.accept_seconds += row.accept_seconds;
  of(from).samples += samples;
  of(from).last_result = transport_->seconds() - begin_;
}

void Producer::take_farewell(const Message& message) {
  ProcessReport& report = of(message.from);
  report.said_farewell = true;
  const ConsumerAccount account = read_account(message.bytes);
  report.tasks = account.tasks;
  report.busy_seconds = account.busy_seconds;
  report.cpu_seconds = account.cpu_seconds;
  report.wait_seconds = account.wait_seconds;
  report.counted = account.counted;
}

void Producer::give_up_silent() {
  for (const ProcessId consumer : crew_.give_up_silent(transport_->seconds())) {
    std::size_t count = 0;
    for (const auto& [number, parcel] : open_) {
      if (parcel.holder != consumer) continue;
      lost_.push_back(number);
      ++count;
    }
    report_.remarks.push_back(
        fmt::format("process {} was silent for {} s; its {} messages' work was given to others",
                    consumer, options_.timeout, count));
  }
}

void Producer::dismiss(ProcessId consumer) {
  of(consumer).from_producer.add(0);
  transport_->send(consumer, Tag::kEnd, {});
  crew_.dismiss(consumer);
}

void Producer::dismiss_idle() {
  for (const ProcessId consumer : crew_.present()) {
    if (crew_.idle(consumer)) dismiss(consumer);
  }
}

/// The end for those, too, that never came or were given up, should they still read it.
void Producer::dismiss_all() {
  for (const ProcessId consumer : crew_.not_dismissed()) dismiss(consumer);
}

}  // namespace beambench::cluster
