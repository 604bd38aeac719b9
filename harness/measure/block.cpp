#include "harness/measure/block.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "harness/measure/contender.hpp"
#include "harness/measure/measurement.hpp"
#include "harness/measure/record/machine.hpp"
#include "harness/measure/task.hpp"
#include "harness/rays/fingerprint.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/random.hpp"

namespace beambench::measure {
namespace {

/// Returns the facts about the view's rays in one order, if an earlier block has determined them.
std::optional<RaySetFacts> known_facts(const Block& block, bool is_sorted) {
  for (const BlockCell& each : block.cells) {
    if (each.earlier.diff && each.cell.rays.is_sorted == is_sorted) return each.earlier.rays;
  }
  return std::nullopt;
}

/// The tasks of a view; the key is whether their rays are sorted.
using Tasks = std::map<bool, std::unique_ptr<Task>>;

/// Makes the tasks of the block's cells, and warns about unexpected rays. Throws what `make_task`
/// throws.
Tasks make_tasks(const Block& block, const CellEvents& events) {
  Tasks tasks;
  for (const BlockCell& each : block.cells) {
    std::unique_ptr<Task>& task = tasks[each.cell.rays.is_sorted];
    if (task) continue;
    const auto known = known_facts(block, each.cell.rays.is_sorted);
    task = make_task(block.view, each.cell.rays, block.core, known);
    if (known) continue;
    if (const auto warning = task->warning()) {
      events.warn(fmt::format("{}: {}.", block.view.shown_name(), *warning));
    }
  }
  return tasks;
}

/// Reports that none of the cells can be measured.
void fail_all(const Block& block, const CellEvents& events, verify::Verdict verdict,
              const std::string& message) {
  for (const BlockCell& each : block.cells) {
    CellRecord record{};
    record.index = each.cell.index;
    record.id = each.cell.id;
    record.rays.scene_hash = block.view.scene_hash;
    record.rays.primitives = block.view.scene->primitives.size();
    record.time_utc = utc_now();
    record.verdict = verdict;
    record.message = message;
    events.begin_cell(record);
    events.finish_cell(record);
  }
}

/// A contender and the number of repetitions that it still needs.
struct Turn {
  Contender contender;
  std::size_t index;
  int due;
};

/// Gives a contender a turn: one repetition, repeated if it was disturbed.
void take(Turn& turn, const Instruments& instruments, int round, int position, int tries,
          const CellEvents& events, const BlockWatch& watch) {
  for (; tries > 0; --tries) {
    watch.before_each_piece(turn.index);
    turn.contender.repeat(instruments, round, position, events);
    if (turn.contender.failed() || turn.contender.record().repetitions.back().is_undisturbed()) {
      break;
    }
  }
  --turn.due;
}

}  // namespace

void measure_block(const Block& block, const GoogleBenchmark& benchmark, const BlockWatch& watch) {
  const CellEvents events(watch.sink);
  watch.before_each_piece(std::nullopt);
  Tasks tasks;
  try {
    tasks = make_tasks(block, events);
  } catch (const rays::NoRaysError& error) {
    return fail_all(block, events, verify::Verdict::kNoRays, error.what());
  } catch (const InputError& error) {
    return fail_all(block, events, verify::Verdict::kError, error.what());
  }
  std::vector<Turn> turns;
  for (const BlockCell& each : block.cells) {
    turns.push_back({Contender(each.cell, *tasks.at(each.cell.rays.is_sorted), block.second_traces,
                               each.earlier),
                     each.cell.index, each.repetitions});
    if (each.earlier.diff) continue;
    watch.before_each_piece(each.cell.index);
    turns.back().contender.count(events);
  }
  const HardwareCounters counters;
  const Instruments instruments{benchmark, counters, block.core, block.view.threads, block.number};
  Random random(rays::fingerprint(fmt::format("{}/{}", block.view.name(), block.number)));
  for (int round = block.first_round; !turns.empty(); ++round) {
    std::erase_if(turns, [](const Turn& t) { return t.contender.failed() || t.due <= 0; });
    shuffle(turns, random);
    int position = 0;
    for (Turn& turn : turns) take(turn, instruments, round, position++, block.tries, events, watch);
  }
}

}  // namespace beambench::measure
