#include "harness/thesis/cluster/split/part_member.hpp"

#include <concepts>
#include <tuple>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "accel/core/registry.hpp"
#include "harness/base/stopwatch.hpp"
#include "harness/thesis/cluster/image_worker.hpp"

namespace beambench::cluster {
namespace {

/// Visits the transmitted members of a report in order.
template <class Report>
auto members(Report& report) requires std::same_as<std::remove_const_t<Report>, PartReport> {
  return std::tie(report.primitives, report.scene_bytes, report.structure_bytes, report.beams_out,
                  report.rays_out, report.crossings_out.messages, report.crossings_out.bytes,
                  report.crossings_in.messages, report.crossings_in.bytes, report.cpu_seconds,
                  report.wait_seconds);
}

}  // namespace

LostProcess silent_part(ProcessId process, double timeout) {
  return LostProcess(
      fmt::format("process {} was silent for {} s, and no other process has its part of the scene; "
                  "no picture was made",
                  process, timeout));
}

PartMember::PartMember(Transport& transport, PartWorker& worker, Outbox& outbox, double timeout,
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

std::vector<Bytes> PartMember::lead() {
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
      throw LostProcess("a process was silent at the end; its part of the image is missing");
    }
  }
  return std::move(results_);
}

void PartMember::follow(const std::function<Bytes()>& result) {
  while (!going_ && !over_) {
    if (const auto message = transport_->wait(Transport::kForever)) handle(*message);
  }
  run();
  transport_->send(kProducer, Tag::kFinalReport, result());
  transport_->flush();
}

PartReport PartMember::report() const {
  PartReport report;
  report.primitives = worker_->scene().primitives.size();
  report.scene_bytes = scenes::memory_bytes(worker_->scene());
  report.structure_bytes = worker_->structure_bytes();
  report.beams_out = outbox_->beams();
  report.rays_out = outbox_->rays();
  report.crossings_out = outbox_->sent();
  report.crossings_in = received_;
  report.cpu_seconds = cpu_seconds_;
  report.wait_seconds = wait_seconds_;
  return report;
}

/// Delays handoffs until all processes are known to have the same scene.
void PartMember::wait_for_all() {
  constexpr double kToLoadAndBuild = 20.0;
  while (missing_ > 0) {
    const auto message = transport_->wait(kToLoadAndBuild * timeout_);
    if (!message) {
      throw LostProcess(fmt::format("no other process became ready within {:.0f} s; {} are missing",
                                    kToLoadAndBuild * timeout_, missing_));
    }
    handle(*message);
  }
  send_others(Tag::kGo);
}

void PartMember::run() {
  while (!over_) {
    while (const auto message = transport_->poll()) handle(*message);
    const base::CpuStopwatch timer;
    const PartWork work = worker_->work();
    if (work == PartWork::kNone) {
      wait_idle();
      continue;
    }
    done(work, timer.seconds());
    outbox_->send(Outbox::kLarge);
    send_heartbeat();
  }
}

void PartMember::handle(const Message& message) {
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
    case Tag::kFinalReport:
      results_[static_cast<std::size_t>(message.from)] = message.bytes;
      --missing_results_;
      break;
    case Tag::kEnd:
      over_ = true;
      break;
    case Tag::kHeartbeat:
      break;
    default:
      throw ProtocolError("an unexpected message for a divided scene");
  }
}

void PartMember::take_crossings(const Message& message) {
  received_.add(message.bytes.size());
  const base::CpuStopwatch timer;
  ByteReader reader(message.bytes);
  while (!reader.at_end()) {
    std::visit([this](const auto& each) { worker_->take(each); },
               read_handoff(reader, worker_->view()));
  }
  done(PartWork::kTaking, timer.seconds());
}

void PartMember::done(PartWork work, double cpu_seconds) {
  cpu_seconds_ += cpu_seconds;
  if (meter_) meter_(work, cpu_seconds);
}

void PartMember::wait_idle() {
  outbox_->send();
  if (transport_->self() == kProducer) {
    if (!in_wave_) begin_wave();
    if (missing_counts_ == 0) return end_wave();
  } else if (asked_) {
    Bytes counts;
    ByteWriter(counts).put(std::tie(outbox_->sent().messages, received_.messages));
    transport_->send(kProducer, Tag::kCount, std::move(counts));
    asked_ = false;
  }
  const double before = transport_->seconds();
  const bool leads = transport_->self() == kProducer;
  const auto message = transport_->wait(leads ? 0.25 * timeout_ : Transport::kForever);
  wait_seconds_ += transport_->seconds() - before;
  if (message) handle(*message);
  if (leads) require_heartbeats();
}

void PartMember::begin_wave() {
  in_wave_ = true;
  wave_ = {};
  missing_counts_ = transport_->processes() - 1;
  for (Other& each : others_) {
    each.answered = false;
    each.last_heard = transport_->seconds();
  }
  send_others(Tag::kAsk);
}

void PartMember::take_count(const Message& message) {
  other(message.from).answered = true;
  ByteReader reader(message.bytes);
  wave_.sent += reader.get<std::uint64_t>();
  wave_.received += reader.get<std::uint64_t>();
  --missing_counts_;
}

/// Also called when this process is idle.
void PartMember::end_wave() {
  wave_.sent += outbox_->sent().messages;
  wave_.received += received_.messages;
  over_ = wave_.sent == wave_.received && last_wave_ == wave_;
  last_wave_ = wave_;
  in_wave_ = false;
}

void PartMember::send_others(Tag tag) {
  for (ProcessId process = kProducer + 1; process < transport_->processes(); ++process) {
    transport_->send(process, tag, {});
  }
}

void PartMember::send_heartbeat() {
  if (transport_->self() == kProducer) return;
  const double now = transport_->seconds();
  if (now - last_sign_ < 0.2 * timeout_) return;
  transport_->send(kProducer, Tag::kHeartbeat, {});
  last_sign_ = now;
}

/// Throws LostProcess if another process is silent. Other processes reply when they are idle, and
/// send heartbeats while they work.
void PartMember::require_heartbeats() {
  if (!in_wave_) return;
  const double now = transport_->seconds();
  for (ProcessId process = kProducer + 1; process < transport_->processes(); ++process) {
    const double silent = now - other(process).last_heard;
    if (other(process).answered || silent <= timeout_) continue;
    throw silent_part(process, timeout_);
  }
}

PartState::PartState(std::shared_ptr<const scenes::Scene> whole, const Job& job,
                     Transport& transport)
    : options(accel::beam::BeamOptions::from(beam_choice(job).parameters())),
      rays(job_image(job, *whole).rays()),
      split(split_scene(*whole, options.octree, rays, job.split_level, job.division,
                        transport.processes())),
      outbox(transport, split) {
  ScenePart part = part_of(*whole, split, transport.self());
  whole.reset();
  split.forget_primitives();
  worker.emplace(std::move(part), split, transport.self(), options, rays, outbox);
}

Bytes write_result(const PartReport& report, const PartWorker& worker) {
  Bytes bytes;
  ByteWriter writer(bytes);
  writer.put(members(report));
  write_hits(worker.hit_samples(), worker.hits(), bytes);
  return bytes;
}

PartReport take_result(std::span<const std::byte> result, accel::HitBuffer& hits) {
  ByteReader reader(result);
  PartReport report;
  reader.get(members(report));
  HitSink(hits).accept(reader.rest());
  return report;
}

}  // namespace beambench::cluster
