#pragma once
// Google Benchmark's command-line flags, as far as beambench supports them.

#include <functional>
#include <iosfwd>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/measure/record/cell_record.hpp"

namespace benchmark {
class State;
}

namespace beambench::measure {

/// The user's Google Benchmark flags.
struct BenchmarkFlags {
  std::vector<std::string> passed_on;  ///< --benchmark_filter, --benchmark_context, --v
  std::optional<int> repetitions;      ///< --benchmark_repetitions
  bool list = false;                   ///< --benchmark_list_tests
  std::vector<std::string> notes;      ///< a sentence for each flag without effect, with the reason
};

/// Parses the user's flags. Throws InputError for a flag that beambench does not accept, naming the
/// valid flags.
BenchmarkFlags parse_benchmark_flags(const std::vector<std::string>& arguments);

/// A timed piece of work. It loops over the state once and sets the iteration's time (manual time).
using TimedWork = std::function<void(benchmark::State&)>;

/// Runs timed work through Google Benchmark. Only one object may exist at a time: the library's
/// state is global.
class GoogleBenchmark {
 public:
  /// Throws InputError if the library refuses a flag.
  explicit GoogleBenchmark(const BenchmarkFlags& flags);

  /// Returns the names that --benchmark_filter selects, as matched by the library. Throws
  /// InputError if there are none.
  std::set<std::string> select(std::span<const std::string> names) const;

  /// Runs the work for one iteration. The caller decides whose turn it is: the library's own
  /// interleaving shuffles all repetitions at once and cannot stop one contender earlier than
  /// another.
  void run_once(const std::string& name, const TimedWork& work) const;

  /// Returns the library's description of the machine and the moment: date, load, processor and
  /// caches. Omits the host's name, which must not appear in records.
  nlohmann::ordered_json context() const;
};

/// Writes cells in the format of Google Benchmark's results: one entry for each repetition.
void write_google_benchmark_json(std::ostream& out, const nlohmann::ordered_json& context,
                                 std::span<const CellRecord> cells);

}  // namespace beambench::measure
