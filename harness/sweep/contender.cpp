#include "harness/sweep/contender.hpp"

#include <algorithm>
#include <exception>
#include <limits>
#include <memory>
#include <new>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "harness/record/fingerprint.hpp"
#include "harness/record/machine.hpp"
#include "harness/sweep/conditions.hpp"
#include "harness/sweep/heap.hpp"
#include "harness/sweep/phase_timer.hpp"

namespace beambench {
namespace {

constexpr const char* kError = "error";

/// Fills the buffer with answers that cannot be: the differ finds every sample left unwritten.
void poison(HitBuffer& buffer) {
  std::fill_n(buffer.t(), buffer.size(), std::numeric_limits<float>::quiet_NaN());
  std::fill_n(buffer.primitive(), buffer.size(), kNoPrimitive - 1);
}

RaySetFacts facts_of(const Scene& scene, std::uint64_t scene_hash, const PrimaryRays& rays) {
  constexpr std::uint64_t kNothingRandom = 0;
  return {scene_hash, fingerprint(rays), kNothingRandom, scene.primitives.size(), rays.count()};
}

std::string mismatch_message(const DiffReport& report) {
  if (report.verdict == Verdict::kGrazes) {
    return fmt::format("{} of {} rays graze, more than the differ's budget",
                       report.count(DiffClass::kGraze), report.rays);
  }
  return fmt::format("{} of {} rays got a wrong hit", report.count(DiffClass::kEngineError),
                     report.rays);
}

/// What an exception says to the user.
std::string message_of(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) {
    return "the memory does not suffice for this structure over this scene";
  }
  return error.what();
}

bool is_all_zero(const std::map<std::string, std::uint64_t, std::less<>>& counters) {
  return std::all_of(counters.begin(), counters.end(),
                     [](const auto& counter) { return counter.second == 0; });
}

}  // namespace

SharedQuestion::SharedQuestion(const CellGroup& group, std::uint64_t scene_hash)
    : scene_(group.scene.get()),
      rays_(group.camera, group.resolution.width, group.resolution.height, group.samples),
      reference_(*scene_, rays_),
      facts_(facts_of(*scene_, scene_hash, rays_)),
      buffer_(rays_.width(), rays_.height(), rays_.samples()) {}

Contender::Contender(const PlannedCell& cell, SharedQuestion& question)
    : cell_(&cell), question_(&question) {
  record_.index = cell.index;
  record_.id = cell.id;
  record_.rays = question.facts();
}

void Contender::count() {
  try {
    const MeasuringFloatMode mode;
    const auto heap_before = heap_in_use();
    const auto structure = cell_->structure.build(question_->scene());
    record_.allocated_bytes = heap_growth(heap_before, heap_in_use());
    WorkCounters counters;
    poison(question_->buffer());
    structure->trace(question_->rays(), question_->buffer(), counters);
    counted_hits_ = fingerprint(question_->buffer());
    record_.statistics = structure->statistics();
    record_.counters = counters.by_name();
  } catch (const std::exception& error) {
    fail(kError, message_of(error));
  }
  // A structure that counts nothing at all cannot count; zeros would claim that it does no work.
  if (is_all_zero(record_.counters)) record_.counters.clear();
}

void Contender::repeat(const Instruments& instruments, int round, int position) {
  try {
    Repetition repetition{};
    {
      const PinnedThread pin(instruments.core);
      poison(question_->buffer());
      repetition = time_once(instruments);
    }
    repetition.round = round;
    repetition.position = position;
    record_.repetitions.push_back(repetition);
    totals_ms_.push_back(repetition.total_ms());
    spent_ms_ += repetition.total_ms();
    examine();
  } catch (const std::exception& error) {
    fail(kError, message_of(error));
  }
}

Repetition Contender::time_once(const Instruments& instruments) {
  Repetition repetition{};
  std::exception_ptr problem;
  std::unique_ptr<Accelerator> structure;  // destroyed outside of the timed loop
  instruments.benchmark.run_once(cell_->id.name(), [&](benchmark::State& state) {
    const MeasuringFloatMode mode;
    try {
      for ([[maybe_unused]] auto iteration : state) {
        PhaseTime build{};
        PhaseTime trace{};
        const HardwareCounts build_counts = instruments.counters.count([&] {
          build = time_phase([&] { structure = cell_->structure.build(question_->scene()); });
        });
        const HardwareCounts trace_counts = instruments.counters.count([&] {
          trace = time_phase([&] { structure->trace(question_->rays(), question_->buffer()); });
        });
        state.SetIterationTime(1e-3 * (build.wall_ms + trace.wall_ms));
        repetition = {
            0,           0, build.wall_ms, trace.wall_ms, build.cpu_ms, trace.cpu_ms, build_counts,
            trace_counts};
      }
    } catch (...) {
      // The library is not made for exceptions to pass through it.
      problem = std::current_exception();
      state.SkipWithError("the structure threw");
    }
  });
  if (problem) std::rethrow_exception(problem);
  return repetition;
}

void Contender::examine() {
  const bool first = record_.repetitions.size() == 1;
  if (first) return judge_first();
  if (fingerprint(question_->buffer()) == record_.hits_hash) return;
  fail(std::string(to_string(Verdict::kMismatch)),
       fmt::format("repetition {} wrote other hits than the first: the structure's answers depend "
                   "on more than scene and rays",
                   record_.repetitions.size()));
}

void Contender::judge_first() {
  const HitBuffer& buffer = question_->buffer();
  record_.hits_hash = fingerprint(buffer);
  record_.diff = judge(question_->reference(), buffer, cell_->structure.info().conformance);
  record_.verdict = to_string(record_.diff->verdict);
  if (!record_.keeps_times()) {
    const ReplayCommand replay(question_->scene(), cell_->id.camera, cell_->structure,
                               question_->rays());
    for (const Mismatch& example : record_.diff->examples) {
      record_.examples.push_back(describe(question_->scene(), example, replay));
    }
    return fail(record_.verdict, mismatch_message(*record_.diff));
  }
  if (record_.hits_hash != counted_hits_) {
    fail(std::string(to_string(Verdict::kMismatch)),
         "the counting pass found other hits than the timed one");
  }
}

void Contender::fail(std::string verdict, std::string message) {
  record_.verdict = std::move(verdict);
  record_.message = std::move(message);
  failed_ = true;
}

CellRecord Contender::finish(std::optional<StopReason> reason) && {
  record_.stop_reason = reason;
  record_.time_utc = utc_now();
  return std::move(record_);
}

}  // namespace beambench
