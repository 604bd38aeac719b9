#include "harness/measure/contender.hpp"

#include <algorithm>
#include <exception>
#include <memory>
#include <new>
#include <utility>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "accel/core/moved_structure.hpp"
#include "accel/core/tree_quality.hpp"
#include "harness/measure/measurement.hpp"
#include "harness/measure/record/machine.hpp"
#include "harness/plugin/program_contender.hpp"
#include "scenes/base/process_memory.hpp"

namespace beambench::measure {
namespace {

std::string mismatch_message(const verify::DiffReport& report) {
  if (report.verdict == verify::Verdict::kGrazes) {
    return fmt::format("{} of {} rays graze, more than the differ allows",
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

/// Returns the time of a phase: by the program's own clock (`figure`) if the structure is in
/// another process, otherwise as measured. The CPU time of another process is unknown: the process
/// counts as busy all the time.
PhaseTime own_time(const accel::StructureInfo& info, const accel::Accelerator& structure,
                   const char* figure, const PhaseTime& measured) {
  if (info.origin.empty()) return measured;
  const auto own = structure.statistics().figure(figure);
  return own ? PhaseTime{*own, *own} : measured;
}

}  // namespace

Contender::Contender(const PlannedCell& cell, Task& task, int second_traces, CellRecord earlier)
    : cell_(&cell),
      task_(&task),
      second_traces_(static_cast<std::size_t>(second_traces)),
      record_(std::move(earlier)) {
  record_.index = cell.index;
  record_.id = cell.id;
  record_.parameter_sets = cell.parameter_sets;
  record_.rays = task.facts();
}

void Contender::count(const CellEvents& events) {
  try {
    task_->require_support(cell_->structure);
    const MeasuringFloatMode mode;
    const auto heap_before = heap_in_use();
    std::unique_ptr<accel::Accelerator> structure;
    record_.peak_build_bytes = peak_memory_growth(
        [&] { structure = cell_->structure.build(task_->scene(), task_->workload()); });
    record_.allocated_bytes = heap_growth(heap_before, heap_in_use());
    task_->poison();
    record_.work = task_->count(*structure);
    counted_hits_ = task_->fingerprint();
    record_.statistics = structure->statistics();
    accel::append_quality(*structure, task_->scene(), *record_.statistics);
    record_.harness = task_->harness_share(*structure);
  } catch (const accel::UnsupportedError& error) {
    fail(verify::Verdict::kUnsupported, error.what());
  } catch (const std::exception& error) {
    fail(verify::Verdict::kError, message_of(error));
  }
  // A structure without any counts does not support counting; zeros would suggest that it does no
  // work.
  if (is_all_zero(record_.work.counters)) record_.work.counters.clear();
  events.begin_cell(record_);
  if (failed_) finish(events);
}

void Contender::repeat(const Instruments& instruments, int round, int position,
                       const CellEvents& events) {
  const bool was_verified = record_.diff.has_value();
  try {
    const PinnedThread pin(instruments.core);
    task_->poison();
    std::unique_ptr<accel::Accelerator> structure;
    const double clock_before = clock_ghz();
    Repetition repetition = time_once(instruments, structure);
    repetition.clock_ghz = 0.5 * (clock_before + clock_ghz());
    repetition.block = instruments.block;
    repetition.round = round;
    repetition.position = position;
    record_.repetitions.push_back(repetition);
    check_answers(*structure);
    if (!failed_ && record_.repetitions.size() <= second_traces_) trace_warm(*structure);
  } catch (const std::exception& error) {
    fail(verify::Verdict::kError, message_of(error));
  }
  if (!was_verified && record_.diff) events.add_verification(record_);
  // Finishes without recording the repetition: a run that is cut off now must not resume with a
  // wrong repetition.
  if (failed_) return finish(events);
  events.add_repetition(record_);
}

void Contender::check_answers(const accel::Accelerator& structure) {
  if (record_.hits_hash && task_->fingerprint() != record_.hits_hash) {
    return fail(verify::Verdict::kMismatch,
                fmt::format("repetition {} wrote different hits than the first: the structure's "
                            "results depend on more than the scene and the rays",
                            record_.repetitions.size()));
  }
  if (!record_.diff) verify_first(structure);
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
        // Not StructureChoice::build: its checks were made when the work was counted.
        const accel::StructureChoice& choice = cell_->structure;
        const auto time_build = [&](const auto& make) {
          repetition.build_counts = instruments.counters.count([&] { build = time_phase(make); });
        };
        if (choice.updates()) {
          auto moving = accel::copy_first_frame(task_->scene());
          std::unique_ptr<accel::MovedStructure> moved;
          time_build([&] {
            moved = std::make_unique<accel::MovedStructure>(choice, task_->scene(),
                                                            std::move(moving), task_->workload());
          });
          moved->place();
          const PhaseTime update = time_phase([&] { moved->update(); });
          repetition.update_ms = update.wall_ms;
          repetition.update_cpu_ms = update.cpu_ms;
          structure = std::move(moved);
        } else {
          time_build([&] {
            structure = choice.info().build(task_->scene(), choice.parameters(), task_->workload());
          });
        }
        HardwareCounts trace_counts = instruments.counters.count([&] {
          trace = time_phase([&] { task_->trace(*structure); }, cpu_clock(instruments.threads));
        });
        build = own_time(choice.info(), *structure, plugin::kSelfReportedBuild, build);
        trace = own_time(choice.info(), *structure, plugin::kSelfReportedTrace, trace);
        if (instruments.threads > 1) trace_counts = {};  // counts only the calling thread
        repetition.build_ms = build.wall_ms;
        repetition.trace_ms = trace.wall_ms;
        repetition.build_cpu_ms = build.cpu_ms;
        repetition.trace_cpu_ms = trace.cpu_ms;
        repetition.trace_counts = trace_counts;
        state.SetIterationTime(1e-3 * repetition.total_ms());
      }
    } catch (...) {
      // The library is not designed to let exceptions pass through it.
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
  record_.repetitions.back().warm_trace_ms =
      own_time(cell_->structure.info(), structure, plugin::kSelfReportedTrace, again).wall_ms;
  if (task_->fingerprint() == record_.hits_hash) return;
  fail(verify::Verdict::kMismatch,
       "a second trace of the same structure wrote different hits than its first");
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
    return fail(
        verify::Verdict::kMismatch,
        "the structure returned different results when it was traced again for verification");
  }
  if (record_.hits_hash != counted_hits_) {
    fail(verify::Verdict::kMismatch, "the counting pass found different hits than the timed one");
  }
}

void Contender::fail(verify::Verdict verdict, std::string message) {
  record_.verdict = verdict;
  record_.message = std::move(message);
  failed_ = true;
}

void Contender::finish(const CellEvents& events) {
  record_.time_utc = utc_now();
  record_.is_finished = true;
  events.finish_cell(record_);
}

}  // namespace beambench::measure
