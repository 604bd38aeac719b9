#include "harness/cluster/split/split_member.hpp"

#include <utility>

#include <fmt/format.h>

#include "harness/base/stopwatch.hpp"

namespace beambench::cluster {
namespace {

constexpr std::size_t kLarge = 1 << 15;  // bytes that are worth a message before all is done

}  // namespace

void write_account(const SplitAccount& account, ByteWriter& writer) {
  for (const std::uint64_t number :
       {account.primitives, account.scene_bytes, account.structure_bytes, account.beams_out,
        account.rays_out, account.crossings_out.messages, account.crossings_out.bytes,
        account.crossings_in.messages, account.crossings_in.bytes}) {
    writer.put(number);
  }
  writer.put(account.cpu_seconds);
  writer.put(account.wait_seconds);
}

SplitAccount read_split_account(ByteReader& reader) {
  SplitAccount account;
  for (std::uint64_t* number :
       {&account.primitives, &account.scene_bytes, &account.structure_bytes, &account.beams_out,
        &account.rays_out, &account.crossings_out.messages, &account.crossings_out.bytes,
        &account.crossings_in.messages, &account.crossings_in.bytes}) {
    *number = reader.get<std::uint64_t>();
  }
  account.cpu_seconds = reader.get<double>();
  account.wait_seconds = reader.get<double>();
  return account;
}

Outbox::Outbox(Transport& transport, const SceneSplit& split)
    : transport_(&transport),
      split_(&split),
      open_(static_cast<std::size_t>(transport.processes())) {}

void Outbox::hand_over(const CrossingBeam& beam) {
  write_traveler(beam, open_[static_cast<std::size_t>(split_->owner(beam.cell))]);
  ++beams_;
}

void Outbox::hand_over(const CrossingRay& ray) {
  write_traveler(ray, open_[static_cast<std::size_t>(split_->owner(ray.cell))]);
  ++rays_;
}

void Outbox::send_large() {
  for (std::size_t i = 0; i < open_.size(); ++i) {
    if (open_[i].size() >= kLarge) send(i);
  }
}

void Outbox::send_all() {
  for (std::size_t i = 0; i < open_.size(); ++i) {
    if (!open_[i].empty()) send(i);
  }
}

void Outbox::send(std::size_t process) {
  sent_.add(open_[process].size());
  transport_->send(static_cast<ProcessId>(process), Tag::kCross, std::exchange(open_[process], {}));
}

SplitMember::SplitMember(Transport& transport, SplitWorker& worker, Outbox& outbox, double timeout,
                         Check check, Meter meter)
    : transport_(&transport),
      worker_(&worker),
      outbox_(&outbox),
      timeout_(timeout),
      check_(std::move(check)),
      meter_(std::move(meter)),
      others_(static_cast<std::size_t>(transport.processes())),
      results_(static_cast<std::size_t>(transport.processes())),
      missing_(transport.processes() - 1),
      missing_results_(transport.processes() - 1) {}

std::vector<Bytes> SplitMember::lead() {
  try {
    wait_for_all();
    run();
  } catch (...) {
    send_others(Tag::kEnd);
    throw;
  }
  send_others(Tag::kEnd);
  while (missing_results_ > 0) {
    if (const auto message = transport_->wait(timeout_)) {
      handle(*message);
    } else {
      throw LostProcess("a process fell silent at the end; its part of the image is missing");
    }
  }
  return std::move(results_);
}

void SplitMember::follow(const std::function<Bytes()>& result) {
  while (!going_ && !over_) {
    if (const auto message = transport_->wait(Transport::kForever)) handle(*message);
  }
  run();
  transport_->send(kProducer, Tag::kFarewell, result());
  transport_->flush();
}

SplitAccount SplitMember::account() const {
  SplitAccount account;
  account.primitives = worker_->scene().primitives.size();
  account.scene_bytes = scenes::memory_bytes(worker_->scene());
  account.structure_bytes = worker_->structure_bytes();
  account.beams_out = outbox_->beams();
  account.rays_out = outbox_->rays();
  account.crossings_out = outbox_->sent();
  account.crossings_in = received_;
  account.cpu_seconds = cpu_seconds_;
  account.wait_seconds = wait_seconds_;
  return account;
}

/// Nothing is handed over before all are known to have the same scene.
void SplitMember::wait_for_all() {
  constexpr double kToLoadAndBuild = 20.0;
  while (missing_ > 0) {
    const auto message = transport_->wait(kToLoadAndBuild * timeout_);
    if (!message) {
      throw LostProcess(fmt::format("no process became ready for {:.0f} s; {} are missing",
                                    kToLoadAndBuild * timeout_, missing_));
    }
    handle(*message);
  }
  send_others(Tag::kGo);
}

void SplitMember::run() {
  while (!over_) {
    while (const auto message = transport_->poll()) handle(*message);
    const base::CpuStopwatch timer;
    const SplitWork work = worker_->work();
    if (work == SplitWork::kNone) {
      have_nothing_to_do();
      continue;
    }
    done(work, timer.seconds());
    outbox_->send_large();
    give_sign_of_life();
  }
}

void SplitMember::handle(const Message& message) {
  other(message.from).last_heard = transport_->seconds();
  switch (message.tag) {
    case Tag::kCross:
      take_crossings(message);
      break;
    case Tag::kAsk:
      asked_ = true;
      break;
    case Tag::kCount:
      take_count(message);
      break;
    case Tag::kReady:
      check_(message.from, message.bytes);
      --missing_;
      break;
    case Tag::kGo:
      going_ = true;
      break;
    case Tag::kFarewell:
      results_[static_cast<std::size_t>(message.from)] = message.bytes;
      --missing_results_;
      break;
    case Tag::kEnd:
      over_ = true;
      break;
    case Tag::kAlive:
      break;
    default:
      throw ProtocolError("a message of another kind of work");
  }
}

void SplitMember::take_crossings(const Message& message) {
  received_.add(message.bytes.size());
  const base::CpuStopwatch timer;
  ByteReader reader(message.bytes);
  while (!reader.at_end()) {
    std::visit([this](const auto& each) { worker_->take(each); },
               read_traveler(reader, worker_->view()));
  }
  done(SplitWork::kTaking, timer.seconds());
}

void SplitMember::done(SplitWork work, double cpu_seconds) {
  cpu_seconds_ += cpu_seconds;
  if (meter_) meter_(work, cpu_seconds);
}

void SplitMember::have_nothing_to_do() {
  outbox_->send_all();
  if (transport_->self() == kProducer) {
    if (!in_wave_) begin_wave();
    if (missing_counts_ == 0) return end_wave();
  } else if (asked_) {
    answer();
  }
  const double before = transport_->seconds();
  const bool leads = transport_->self() == kProducer;
  const auto message = transport_->wait(leads ? 0.25 * timeout_ : Transport::kForever);
  wait_seconds_ += transport_->seconds() - before;
  if (message) handle(*message);
  if (leads) require_signs_of_life();
}

void SplitMember::answer() {
  Bytes bytes;
  ByteWriter writer(bytes);
  writer.put(outbox_->sent().messages);
  writer.put(received_.messages);
  transport_->send(kProducer, Tag::kCount, std::move(bytes));
  asked_ = false;
}

void SplitMember::begin_wave() {
  in_wave_ = true;
  wave_ = {};
  missing_counts_ = transport_->processes() - 1;
  for (Other& each : others_) {
    each.answered = false;
    each.last_heard = transport_->seconds();
  }
  send_others(Tag::kAsk);
}

void SplitMember::take_count(const Message& message) {
  other(message.from).answered = true;
  ByteReader reader(message.bytes);
  wave_.sent += reader.get<std::uint64_t>();
  wave_.received += reader.get<std::uint64_t>();
  --missing_counts_;
}

/// Called when this process has nothing to do, either.
void SplitMember::end_wave() {
  wave_.sent += outbox_->sent().messages;
  wave_.received += received_.messages;
  over_ = wave_.sent == wave_.received && last_wave_ && last_wave_->sent == wave_.sent &&
          last_wave_->received == wave_.received;
  last_wave_ = wave_;
  in_wave_ = false;
}

void SplitMember::send_others(Tag tag) {
  for (ProcessId process = kProducer + 1; process < transport_->processes(); ++process) {
    transport_->send(process, tag, {});
  }
}

void SplitMember::give_sign_of_life() {
  if (transport_->self() == kProducer) return;
  const double now = transport_->seconds();
  if (now - last_sign_ < 0.2 * timeout_) return;
  transport_->send(kProducer, Tag::kAlive, {});
  last_sign_ = now;
}

/// Others answer when they have nothing to do, and give signs while they work.
void SplitMember::require_signs_of_life() {
  if (!in_wave_) return;
  const double now = transport_->seconds();
  for (ProcessId process = kProducer + 1; process < transport_->processes(); ++process) {
    const double silent = now - other(process).last_heard;
    if (other(process).answered || silent <= timeout_) continue;
    throw LostProcess(
        fmt::format("process {} was silent for {:.0f} s, and nobody else has its part "
                    "of the scene; no picture was made",
                    process, silent));
  }
}

}  // namespace beambench::cluster
