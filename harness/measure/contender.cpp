#include "harness/measure/contender.hpp"

#include <algorithm>
#include <exception>
#include <memory>
#include <new>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "harness/measure/measurement.hpp"
#include "harness/measure/record/machine.hpp"
#include "harness/measure/record/robust_statistics.hpp"

namespace beambench::measure {
namespace {

std::string mismatch_message(const verify::DiffReport& report) {
  if (report.verdict == verify::Verdict::kGrazes) {
    return fmt::format("{} of {} rays graze, more than the differ's budget",
                       report.count(verify::DiffClass::kGraze), report.rays);
  }
  return fmt::format("{} of {} rays got a wrong hit",
                     report.count(verify::DiffClass::kStructureError), report.rays);
}

std::string message_of(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) {
    return "out of memory for this structure over this scene";
  }
  return error.what();
}

bool is_all_zero(const std::map<std::string, std::uint64_t, std::less<>>& counters) {
  return std::all_of(counters.begin(), counters.end(),
                     [](const auto& counter) { return counter.second == 0; });
}

bool is_precise(std::span<const double> samples, const StoppingRule& rule) {
  if (rule.precise == Figure::kMinimum) {
    const std::optional<double> spread = repeat_spread_of_minimum(samples);
    return spread && *spread <= rule.precision * minimum(samples);
  }
  const std::optional<Interval> interval = repeat_interval(samples);
  return interval && 0.5 * (interval->high - interval->low) <= rule.precision * median(samples);
}

}  // namespace

Contender::Contender(const PlannedCell& cell, Task& task, int second_traces,
                     std::optional<CellRecord> earlier)
    : cell_(&cell), task_(&task), second_traces_(static_cast<std::size_t>(second_traces)) {
  record_.index = cell.index;
  record_.id = cell.id;
  record_.rays = task.facts();
  if (!earlier) return;
  record_.hits_hash = earlier->hits_hash;
  record_.diff = std::move(earlier->diff);
  record_.verdict = earlier->verdict;
  for (const Repetition& repetition : earlier->repetitions) keep(repetition);
}

void Contender::count(RunLog& log) {
  try {
    task_->require_support(cell_->structure);
    const MeasuringFloatMode mode;
    const auto heap_before = heap_in_use();
    const auto structure = cell_->structure.build(task_->scene(), task_->workload());
    record_.allocated_bytes = heap_growth(heap_before, heap_in_use());
    task_->poison();
    record_.work = task_->count(*structure);
    counted_hits_ = task_->fingerprint();
    record_.statistics = structure->statistics();
    record_.harness = task_->harness_share(*structure);
  } catch (const accel::UnsupportedError& error) {
    fail(verify::Verdict::kUnsupported, error.what());
  } catch (const std::exception& error) {
    fail(verify::Verdict::kError, message_of(error));
  }
  // A structure without any counts does not support counting; zeros would claim that it does no
  // work.
  if (is_all_zero(record_.work.counters)) record_.work.counters.clear();
  log.begin_cell(record_);
}

void Contender::repeat(const Instruments& instruments, int round, int position, RunLog& log) {
  const std::size_t before = record_.repetitions.size();
  const bool was_verified = record_.diff.has_value();
  try {
    const PinnedThread pin(instruments.core);
    task_->poison();
    std::unique_ptr<accel::Accelerator> structure;
    const double clock_before = clock_ghz();
    Repetition repetition = time_once(instruments, structure);
    repetition.clock_ghz = 0.5 * (clock_before + clock_ghz());
    repetition.round = round;
    repetition.position = position;
    keep(repetition);
    check_answers(*structure);
    if (!failed_ && record_.repetitions.size() <= second_traces_) trace_warm(*structure);
  } catch (const std::exception& error) {
    fail(verify::Verdict::kError, message_of(error));
  }
  if (!was_verified && record_.diff) log.add_verification(record_);
  if (record_.repetitions.size() > before) log.add_repetition(record_);
}

void Contender::keep(const Repetition& repetition) {
  record_.repetitions.push_back(repetition);
  cycles_.push_back(repetition.total_mcycles());
  milliseconds_.push_back(repetition.total_ms());
  spent_ms_ += repetition.total_ms() + repetition.warm_trace_ms.value_or(0.0);
}

void Contender::check_answers(const accel::Accelerator& structure) {
  if (record_.hits_hash && task_->fingerprint() != record_.hits_hash) {
    return fail(verify::Verdict::kMismatch,
                fmt::format("repetition {} wrote other hits than the first: the structure's "
                            "answers depend on more than scene and rays",
                            record_.repetitions.size()));
  }
  if (!is_verified_) verify_first(structure);
  is_verified_ = true;
}

Repetition Contender::time_once(const Instruments& instruments,
                                std::unique_ptr<accel::Accelerator>& structure) {
  Repetition repetition{};
  std::exception_ptr problem;
  instruments.benchmark.run_once(cell_->id.name(), [&](benchmark::State& state) {
    const MeasuringFloatMode mode;
    try {
      for ([[maybe_unused]] auto iteration : state) {
        PhaseTime build{};
        PhaseTime trace{};
        const HardwareCounts build_counts = instruments.counters.count([&] {
          // Not StructureChoice::build, whose checks were made when the work was counted.
          build = time_phase([&] {
            const accel::StructureChoice& choice = cell_->structure;
            structure = choice.info().build(task_->scene(), choice.parameters(), task_->workload());
          });
        });
        HardwareCounts trace_counts = instruments.counters.count([&] {
          trace = time_phase([&] { task_->trace(*structure); }, cpu_clock(instruments.threads));
        });
        if (instruments.threads > 1) trace_counts = {};  // they are of the calling thread alone
        state.SetIterationTime(1e-3 * (build.wall_ms + trace.wall_ms));
        repetition.build_ms = build.wall_ms;
        repetition.trace_ms = trace.wall_ms;
        repetition.build_cpu_ms = build.cpu_ms;
        repetition.trace_cpu_ms = trace.cpu_ms;
        repetition.build_counts = build_counts;
        repetition.trace_counts = trace_counts;
      }
    } catch (...) {
      // The library is not designed for exceptions to pass through it.
      problem = std::current_exception();
      state.SkipWithError("the structure threw");
    }
  });
  if (problem) std::rethrow_exception(problem);
  return repetition;
}

void Contender::trace_warm(const accel::Accelerator& structure) {
  const MeasuringFloatMode mode;
  task_->poison();
  const PhaseTime again = time_phase([&] { task_->trace(structure); });
  record_.repetitions.back().warm_trace_ms = again.wall_ms;
  spent_ms_ += again.wall_ms;
  if (task_->fingerprint() == record_.hits_hash) return;
  fail(verify::Verdict::kMismatch,
       "a second trace of the same structure wrote other hits than its first");
}

void Contender::verify_first(const accel::Accelerator& structure) {
  record_.hits_hash = task_->fingerprint();
  Verification found = task_->verify_results(structure, cell_->structure);
  record_.diff = std::move(found.report);
  record_.verdict = record_.diff->verdict;
  if (!record_.keeps_times()) {
    record_.examples = std::move(found.examples);
    return fail(record_.verdict, mismatch_message(*record_.diff));
  }
  if (task_->fingerprint() != record_.hits_hash) {
    return fail(verify::Verdict::kMismatch,
                "the structure gave other answers when it was traced again to be verified");
  }
  if (record_.hits_hash != counted_hits_) {
    fail(verify::Verdict::kMismatch, "the counting pass found other hits than the timed one");
  }
}

void Contender::fail(verify::Verdict verdict, std::string message) {
  record_.verdict = verdict;
  record_.message = std::move(message);
  failed_ = true;
}

CellRecord Contender::finish(std::optional<StopReason> reason) && {
  record_.stop_reason = reason;
  record_.time_utc = utc_now();
  record_.is_finished = true;
  return std::move(record_);
}

bool is_look(int repetitions, int minimum) {
  int look = minimum;
  while (look < repetitions) look += std::max(1, look / 4);
  return look == repetitions;
}

std::optional<StopReason> reason_to_stop(std::span<const double> totals, double spent_ms,
                                         double allowance_ms, const StoppingRule& rule) {
  const auto repetitions = static_cast<int>(totals.size());
  if (repetitions < rule.minimum) return std::nullopt;
  if (is_look(repetitions, rule.minimum) && is_precise(totals, rule)) {
    return StopReason::kPrecision;
  }
  if (repetitions >= rule.maximum) return StopReason::kRepetitions;
  if (spent_ms >= allowance_ms) return StopReason::kBudget;
  return std::nullopt;
}

}  // namespace beambench::measure
