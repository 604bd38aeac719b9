#pragma once
// Google Benchmark's command-line flags, as far as they mean something here.

#include <optional>
#include <string>
#include <vector>

namespace beambench::bench {

/// What the user's Google Benchmark flags ask for.
struct BenchmarkFlags {
  std::vector<std::string> passed_on;  ///< --benchmark_filter, --benchmark_context, --v
  std::optional<int> repetitions;      ///< --benchmark_repetitions
  bool list = false;                   ///< --benchmark_list_tests
  std::vector<std::string> notes;      ///< sentences on flags that have no effect here, and why
};

/// Throws InputError for a flag that Google Benchmark does not have or cannot read, naming those
/// that it has.
BenchmarkFlags parse_benchmark_flags(const std::vector<std::string>& arguments);

}  // namespace beambench::bench
