#include "harness/measure/google_benchmark.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <ostream>
#include <sstream>
#include <string_view>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "scenes/base/error.hpp"
#include "scenes/base/json_text.hpp"
#include "scenes/base/printable.hpp"

namespace beambench::measure {
namespace {

constexpr std::array<std::string_view, 3> kPassedOn{"--benchmark_filter", "--benchmark_context",
                                                    "--v"};

/// A flag without effect in beambench, and the reason.
struct Ineffective {
  std::string_view flag;
  std::string_view reason;
};

constexpr std::string_view kDecidedByConfig =
    "the configuration's precision, repetitions and budget_seconds decide the number of "
    "measurements";
constexpr std::string_view kOneRecord =
    "every run writes results.csv and google-benchmark.json to its folder";

constexpr std::array<Ineffective, 12> kIneffective{{
    {"--benchmark_min_time", kDecidedByConfig},
    {"--benchmark_min_warmup_time", "every run warms up the machine once, and each structure"},
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
    throw InputError(
        fmt::format("{}='{}' is not a whole number of at least 1", kRepetitions, value));
  }
  return repetitions;
}

[[noreturn]] void refuse(std::string_view argument) {
  throw InputError(
      fmt::format("unknown argument '{}'; besides its own options, `beambench run` accepts Google "
                  "Benchmark's --benchmark_filter=REGEX, --benchmark_repetitions=N, "
                  "--benchmark_list_tests, --benchmark_context=KEY=VALUE and --v=N",
                  argument));
}

using Json = nlohmann::ordered_json;

/// Records the names of the benchmarks that ran; prints nothing.
class NameCollector : public benchmark::BenchmarkReporter {
 public:
  NameCollector() { SetErrorStream(&messages_); }
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) names_.insert(run.run_name.function_name);
  }
  const std::set<std::string>& names() const { return names_; }
  std::string messages() const { return messages_.str(); }

 private:
  std::set<std::string> names_;
  std::ostringstream messages_;
};

/// Removes the benchmarks from the library's global list again, even when an exception is thrown.
struct RegisteredBenchmarks {
  RegisteredBenchmarks() = default;
  RegisteredBenchmarks(const RegisteredBenchmarks&) = delete;
  RegisteredBenchmarks& operator=(const RegisteredBenchmarks&) = delete;
  ~RegisteredBenchmarks() { benchmark::ClearRegisteredBenchmarks(); }
};

/// A benchmark without a fixed number of iterations ends immediately only by failing.
void do_nothing(benchmark::State& state) { state.SkipWithError("not meant to be measured"); }

benchmark::BenchmarkReporter::Run base_run(const CellRecord& cell) {
  benchmark::BenchmarkReporter::Run run;
  // The library writes control characters of names unescaped, which is invalid JSON.
  run.run_name.function_name = printable(cell.id.name());
  run.run_name.time_type = "manual_time";
  run.family_index = 0;
  run.per_family_instance_index = 0;
  run.repetition_index = 0;
  run.repetitions = 1;
  run.time_unit = benchmark::kMillisecond;
  run.statistics = nullptr;
  return run;
}

/// Version 1.8 of the library renamed the fields.
template <class Run>
void mark_failed(Run& run, const std::string& message) {
  if constexpr (requires { run.error_occurred; }) {
    run.error_occurred = true;
    run.error_message = message;
  } else {
    run.skipped = decltype(run.skipped)::SkippedWithError;
    run.skip_message = message;
  }
}

benchmark::BenchmarkReporter::Run repetition_run(const CellRecord& cell,
                                                 const Repetition& repetition) {
  auto run = base_run(cell);
  run.real_accumulated_time = 1e-3 * repetition.total_ms();
  run.cpu_accumulated_time = 1e-3 * (repetition.build_cpu_ms + repetition.trace_cpu_ms);
  run.counters["build_ms"] = repetition.build_ms;
  run.counters["trace_ms"] = repetition.trace_ms;
  run.counters["rays"] = static_cast<double>(cell.rays.rays);
  return run;
}

std::vector<benchmark::BenchmarkReporter::Run> runs_of(const CellRecord& cell, std::int64_t index) {
  std::vector<benchmark::BenchmarkReporter::Run> runs;
  if (cell.has_times()) {
    for (const Repetition& repetition : cell.repetitions) {
      auto run = repetition_run(cell, repetition);
      run.repetition_index = static_cast<std::int64_t>(runs.size());
      run.repetitions = static_cast<std::int64_t>(cell.repetitions.size());
      runs.push_back(std::move(run));
    }
  }
  if (runs.empty()) mark_failed(runs.emplace_back(base_run(cell)), printable(cell.message));
  for (auto& run : runs) run.family_index = index;
  return runs;
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

GoogleBenchmark::GoogleBenchmark(const BenchmarkFlags& flags) {
  // The library also reads flags from the environment. Flags that would repeat, redirect or list
  // benchmarks are reset: beambench handles repetitions, files and lists itself.
  std::vector<std::string> arguments{"beambench", "--benchmark_min_warmup_time=0",
                                     "--benchmark_repetitions=1", "--benchmark_list_tests=false",
                                     "--benchmark_out="};
  arguments.insert(arguments.end(), flags.passed_on.begin(), flags.passed_on.end());
  std::vector<char*> pointers;
  pointers.reserve(arguments.size());
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  int count = static_cast<int>(pointers.size());
  benchmark::Initialize(&count, pointers.data());
  // The library keeps a pointer to the program's name, and leaves rejected arguments in place.
  benchmark::BenchmarkReporter::Context::executable_name = "beambench";
  if (count > 1) {
    throw InputError(
        fmt::format("Google Benchmark cannot read '{}'; check its value", pointers[1]));
  }
}

std::set<std::string> GoogleBenchmark::select(std::span<const std::string> names) const {
  const RegisteredBenchmarks registered;
  for (const std::string& name : names) benchmark::RegisterBenchmark(name.c_str(), do_nothing);
  NameCollector collector;
  benchmark::RunSpecifiedBenchmarks(&collector);
  if (collector.names().empty()) {
    const std::string complaint = collector.messages();
    if (complaint.find("Could not compile") != std::string::npos) {
      throw InputError(fmt::format("--benchmark_filter='{}' is not a valid regular expression",
                                   benchmark::GetBenchmarkFilter()));
    }
    throw InputError(fmt::format(
        "--benchmark_filter='{}' selects none of the {} cells; list their names with --dry-run",
        benchmark::GetBenchmarkFilter(), names.size()));
  }
  return collector.names();
}

void GoogleBenchmark::run_once(const std::string& name, const TimedWork& work) const {
  const RegisteredBenchmarks registered;
  benchmark::RegisterBenchmark(name.c_str(), work)->Iterations(1)->UseManualTime();
  NameCollector collector;
  benchmark::RunSpecifiedBenchmarks(&collector, ".");
}

Json GoogleBenchmark::context() const {
  std::ostringstream start;
  benchmark::JSONReporter reporter;
  reporter.SetOutputStream(&start);
  reporter.ReportContext(benchmark::BenchmarkReporter::Context());
  Json context = Json::parse(start.str() + "]}").at("context");  // the text ends within a list
  context.erase("host_name");
  return context;
}

void write_google_benchmark_json(std::ostream& out, const Json& context,
                                 std::span<const CellRecord> cells) {
  const std::string text = json_text(Json{{"context", context}, {"benchmarks", Json::array()}});
  out << text.substr(0, text.rfind("[]")) << "[\n";
  benchmark::JSONReporter reporter;
  reporter.SetOutputStream(&out);
  std::int64_t index = 0;
  for (const CellRecord& cell : cells) reporter.ReportRuns(runs_of(cell, index++));
  reporter.Finalize();
}

}  // namespace beambench::measure
