#include "harness/analysis/steadiness.hpp"

#include <cmath>
#include <map>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "harness/measure/record/block_statistics.hpp"

namespace beambench::analysis {
namespace {

using measure::CellRecord;

/// For each block of a view: the mean over its contenders of the logarithm of the time, relative to
/// the contender's own mean.
using Blocks = std::map<int, double>;

Blocks relative_times(std::span<const CellRecord* const> cells) {
  std::map<int, std::vector<double>> logarithms;
  for (const CellRecord* cell : cells) {
    const std::map<int, double> times = measure::trace_by_block(*cell, measure::own_clock(*cell));
    double sum = 0.0;
    for (const auto& [block, time] : times) sum += std::log(time);
    for (const auto& [block, time] : times) {
      logarithms[block].push_back(std::log(time) - sum / static_cast<double>(times.size()));
    }
  }
  Blocks blocks;
  for (const auto& [block, values] : logarithms) {
    blocks[block] =
        std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  }
  return blocks;
}

/// Sums over views.
struct Pool {
  double shifts = 0.0;     ///< late minus early
  double variances = 0.0;  ///< variances of the shifts, in units of a block's variance
  double squares = 0.0;    ///< squared distances from the means of the halves
  int degrees = 0;
  int views = 0;

  void add(const Blocks& blocks) {
    std::vector<double> values;
    for (const auto& [block, value] : blocks) values.push_back(value);
    const std::size_t half = values.size() / 2;
    if (half < 2) return;
    const auto count = static_cast<double>(half);
    const std::span early = std::span(values).first(half), late = std::span(values).last(half);
    const auto mean = [&](std::span<const double> of) {
      return std::accumulate(of.begin(), of.end(), 0.0) / count;
    };
    for (const auto& part : {early, late}) {
      for (const double value : part) squares += std::pow(value - mean(part), 2);
    }
    shifts += mean(late) - mean(early);
    variances += 2.0 / count;
    degrees += 2 * (static_cast<int>(half) - 1);
    ++views;
  }
};

}  // namespace

std::optional<Steadiness> steadiness(const measure::Run& run) {
  std::map<std::string, std::vector<const CellRecord*>> views;
  for (const CellRecord& cell : run.cells) {
    if (!cell.has_times() || cell.repetitions.front().block < 0) continue;
    const std::string name = cell.id.name();
    views[name.substr(0, name.rfind('/'))].push_back(&cell);
  }
  Pool pool;
  for (const auto& [view, cells] : views) pool.add(relative_times(cells));
  if (pool.views == 0) return std::nullopt;
  const double deviation = std::sqrt(pool.squares / pool.degrees);
  return Steadiness{pool.shifts / pool.views, measure::student_t(pool.degrees) * deviation *
                                                  std::sqrt(pool.variances) / pool.views};
}

}  // namespace beambench::analysis
