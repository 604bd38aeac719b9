#include "harness/thesis/cluster/split/light_run.hpp"

#include <algorithm>
#include <chrono>
#include <concepts>
#include <cstddef>
#include <future>
#include <optional>
#include <tuple>
#include <type_traits>
#include <utility>

#include "harness/base/stopwatch.hpp"
#include "harness/thesis/cluster/split/part_member.hpp"

namespace beambench::cluster {
namespace {

/// The number of parts of a picture that are drawn at the same time. Each part has a thread, which
/// mostly waits for a round of rays.
constexpr int kDrawn = 16;

/// Visits the transmitted members of a report in order.
template <class Report>
auto members(Report& report) requires std::same_as<std::remove_const_t<Report>, LightReport> {
  return std::tie(report.rays_out, report.answers_out, report.out.messages, report.out.bytes,
                  report.rays_in.messages, report.rays_in.bytes, report.cpu_seconds);
}

LightReport report_of(const LightOutbox& outbox, const LightRelay& relay) {
  return {outbox.rays(), outbox.answers(), outbox.sent(), relay.received(), relay.cpu_seconds()};
}

}  // namespace

LightLeader::LightLeader(Transport& transport, const PartWorker& worker, const SceneSplit& split,
                         double timeout)
    : transport_(&transport),
      timeout_(timeout),
      scene_(worker.single_rays(), exchange_, worker.statistics()),
      outbox_(transport, split),
      relay_(worker.single_rays(), split, kProducer, outbox_,
             [this](const LightAnswer& answer) { exchange_.answer(answer); }),
      last_heard_(static_cast<std::size_t>(transport.processes()), transport.seconds()),
      reports_(static_cast<std::size_t>(transport.processes())),
      missing_reports_(transport.processes() - 1) {}

DrawnLight LightLeader::draw(const scenes::Scene& whole, const render::WhittedOptions& options,
                             const rays::HitCheck& check, const accel::PrimaryRays& rays,
                             const accel::HitBuffer& hits) {
  const double begin = transport_->seconds();
  std::optional<render::WhittedPicture> picture;
  std::vector<LightReport> reports = answer([&](const accel::Accelerator& divided) {
    const render::Whitted tracer(whole, divided, options, check);
    // More threads than cores, because the threads mostly wait.
    picture = render::whitted_picture(tracer, rays, hits, {}, kDrawn);
  });
  return {std::move(picture->image), picture->census, std::move(reports),
          transport_->seconds() - begin};
}

std::vector<LightReport> LightLeader::answer(const Asking& asking) {
  const base::CpuStopwatch timer(CLOCK_PROCESS_CPUTIME_ID);
  try {
    answer_until_done(std::async(std::launch::async, [&] { asking(scene_); }));
  } catch (...) {
    end_others();
    throw;
  }
  end_others();
  reports_[kProducer] = report_of(outbox_, relay_);
  reports_[kProducer].cpu_seconds = timer.seconds();
  collect_reports();
  return std::move(reports_);
}

/// Sends and receives in this thread, on behalf of the querying threads.
void LightLeader::answer_until_done(std::future<void> asked) {
  constexpr std::chrono::microseconds kMoment(100);
  try {
    while (asked.wait_for(std::chrono::seconds(0)) == std::future_status::timeout) {
      while (const auto message = transport_->poll()) handle(*message);
      require_signs();
      const bool worked = relay_.work();
      for (const LightRay& ray : exchange_.take(worked ? std::chrono::microseconds(0) : kMoment)) {
        outbox_.hand_over(ray);
      }
      outbox_.send(worked ? LightOutbox::kLarge : 1);
    }
  } catch (...) {
    exchange_.close();  // otherwise querying threads would wait forever
    throw;
  }
  asked.get();
}

void LightLeader::handle(const Message& message) {
  last_heard_[static_cast<std::size_t>(message.from)] = transport_->seconds();
  switch (message.tag) {
    case Tag::kLight:
      relay_.take(message.bytes);
      break;
    case Tag::kAnswers:
      for (const LightAnswer& answer : read_light_answers(message.bytes)) exchange_.answer(answer);
      break;
    case Tag::kFinalReport: {
      ByteReader reader(message.bytes);
      reader.get(members(reports_[static_cast<std::size_t>(message.from)]));
      --missing_reports_;
      break;
    }
    case Tag::kHeartbeat:
      break;
    default:
      throw ProtocolError("an unexpected message while the light of a divided scene is computed");
  }
}

void LightLeader::require_signs() {
  const double now = transport_->seconds();
  for (ProcessId process = kProducer + 1; process < transport_->processes(); ++process) {
    const double silent = now - last_heard_[static_cast<std::size_t>(process)];
    if (silent > timeout_) throw silent_part(process, timeout_);
  }
}

void LightLeader::end_others() {
  for (ProcessId process = kProducer + 1; process < transport_->processes(); ++process) {
    transport_->send(process, Tag::kEnd, {});
  }
}

void LightLeader::collect_reports() {
  while (missing_reports_ > 0) {
    const auto message = transport_->wait(timeout_);
    if (!message) throw LostProcess("a process was silent when the picture was drawn");
    handle(*message);
  }
}

void serve_light(Transport& transport, const PartWorker& worker, const SceneSplit& split,
                 double heartbeat_interval) {
  LightOutbox outbox(transport, split);
  LightRelay relay(worker.single_rays(), split, transport.self(), outbox,
                   [&](const LightAnswer& answer) { outbox.answer(answer); });
  bool over = false;
  const auto handle = [&](const Message& message) {
    if (message.tag == Tag::kLight) {
      relay.take(message.bytes);
    } else if (message.tag == Tag::kEnd) {
      over = true;
    } else {
      throw ProtocolError("an unexpected message while the light of a divided scene is computed");
    }
  };
  double last_sign = transport.seconds();
  while (!over) {
    while (const auto message = transport.poll()) handle(*message);
    if (relay.work()) {
      outbox.send(LightOutbox::kLarge);
    } else {
      outbox.send();
      if (const auto message = transport.wait(heartbeat_interval)) handle(*message);
    }
    if (transport.seconds() - last_sign < heartbeat_interval) continue;
    transport.send(kProducer, Tag::kHeartbeat, {});
    last_sign = transport.seconds();
  }
  Bytes report;
  const LightReport done = report_of(outbox, relay);
  ByteWriter(report).put(members(done));
  transport.send(kProducer, Tag::kFinalReport, std::move(report));
  transport.flush();
}

}  // namespace beambench::cluster
