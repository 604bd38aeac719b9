#include "harness/bench/benchmark_flags.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

#include <fmt/format.h>

#include "scenes/core/error.hpp"

namespace beambench::bench {
namespace {

constexpr std::array<std::string_view, 3> kPassedOn{"--benchmark_filter", "--benchmark_context",
                                                    "--v"};

/// A flag that beambench takes no notice of, and why.
struct Ineffective {
  std::string_view flag;
  std::string_view reason;
};

constexpr std::string_view kDecidedByConfig =
    "the configuration's precision, repetitions and budget_seconds decide how often is measured";
constexpr std::string_view kOneRecord =
    "every run writes results.csv and google-benchmark.json into its folder";

constexpr std::array<Ineffective, 12> kIneffective{{
    {"--benchmark_min_time", kDecidedByConfig},
    {"--benchmark_min_warmup_time", "every run warms the machine up once, each structure untimed"},
    {"--benchmark_enable_random_interleaving", "contenders always take turns in random order"},
    {"--benchmark_report_aggregates_only", kOneRecord},
    {"--benchmark_display_aggregates_only", kOneRecord},
    {"--benchmark_format", kOneRecord},
    {"--benchmark_out", kOneRecord},
    {"--benchmark_out_format", kOneRecord},
    {"--benchmark_color", kOneRecord},
    {"--benchmark_counters_tabular", kOneRecord},
    {"--benchmark_time_unit", "records are in milliseconds"},
    {"--benchmark_perf_counters", "Debian's Google Benchmark is built without libpfm"},
}};

constexpr std::string_view kRepetitions = "--benchmark_repetitions";
constexpr std::string_view kListTests = "--benchmark_list_tests";

int parse_repetitions(std::string_view value) {
  int repetitions = 0;
  const char* end = value.data() + value.size();
  const auto [rest, error] = std::from_chars(value.data(), end, repetitions);
  if (error != std::errc() || rest != end || repetitions < 1) {
    throw InputError(fmt::format("{}='{}' is not a whole number from 1", kRepetitions, value));
  }
  return repetitions;
}

[[noreturn]] void refuse(std::string_view argument) {
  throw InputError(
      fmt::format("unknown argument '{}'; beside its own options, `beambench run` takes Google "
                  "Benchmark's --benchmark_filter=REGEX, --benchmark_repetitions=N, "
                  "--benchmark_list_tests, --benchmark_context=KEY=VALUE and --v=N",
                  argument));
}

}  // namespace

BenchmarkFlags parse_benchmark_flags(const std::vector<std::string>& arguments) {
  BenchmarkFlags flags;
  for (const std::string& argument : arguments) {
    const std::size_t equals = argument.find('=');
    const std::string_view flag = std::string_view(argument).substr(0, equals);
    const std::string_view value = equals == std::string::npos
                                       ? std::string_view()
                                       : std::string_view(argument).substr(equals + 1);
    const auto ineffective =
        std::find_if(kIneffective.begin(), kIneffective.end(),
                     [&](const Ineffective& known) { return known.flag == flag; });
    if (std::find(kPassedOn.begin(), kPassedOn.end(), flag) != kPassedOn.end()) {
      flags.passed_on.push_back(argument);
    } else if (ineffective != kIneffective.end()) {
      flags.notes.push_back(fmt::format("{} has no effect: {}", flag, ineffective->reason));
    } else if (flag == kRepetitions) {
      flags.repetitions = parse_repetitions(value);
    } else if (flag == kListTests) {
      flags.list = value != "false" && value != "0";
    } else {
      refuse(argument);
    }
  }
  return flags;
}

}  // namespace beambench::bench
