// Runs sweeps in this process.

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nlohmann/json.hpp>

#include "accel/core/registry.hpp"
#include "harness/analysis/exports.hpp"
#include "harness/analysis/words.hpp"
#include "harness/measure/config.hpp"
#include "harness/measure/google_benchmark.hpp"
#include "harness/measure/plan.hpp"
#include "harness/measure/sweep_run.hpp"
#include "harness/python/bindings.hpp"
#include "harness/python/interruption.hpp"
#include "scenes/base/json_text.hpp"

namespace beambench::python {
namespace {

namespace nb = nanobind;

/// Locks Google Benchmark's global state: only one sweep runs at a time, later ones wait. An
/// interrupted sweep may continue until its current repetition ends.
std::unique_lock<std::mutex> lock_benchmark(const StopRequest& stop) {
  static std::mutex running;
  std::unique_lock lock(running, std::try_to_lock);
  while (!lock.owns_lock()) {
    stop.check();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    static_cast<void>(lock.try_lock());
  }
  return lock;
}

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

/// Returns a configuration from JSON or, if that is empty, from a file.
measure::SweepConfig read_config(const std::string& json, const std::string& file) {
  if (json.empty()) return measure::read_sweep(file, accel::registry());
  return measure::parse_sweep(parse_json<nlohmann::json>(json, "config"), "config",
                              accel::registry());
}

std::tuple<nb::bytes, std::string> run_sweep(const std::string& json, const nb::bytes& file_given,
                                             const nb::bytes& folder_given, bool resume,
                                             bool progress) {
  const std::string file = text_of(file_given);
  const std::string folder = text_of(folder_given);
  std::string summary;
  {
    const nb::gil_scoped_release released;
    const measure::SweepConfig config = read_config(json, file);
    summary = result_of([config, folder, resume, progress](const StopRequest& stop) {
      const auto lock = lock_benchmark(stop);
      const std::unique_ptr<std::FILE, CloseFile> nowhere(std::fopen("/dev/null", "w"));
      measure::SweepOptions options;
      options.folder = folder;
      options.resume = resume;
      options.before_each_piece = [&] { stop.check(); };
      return analysis::summary(analysis::conclude(
          measure::run_sweep(config, measure::make_plan(config), measure::GoogleBenchmark({}),
                             options, progress ? stderr : nowhere.get())));
    });
  }
  const std::string results = (std::filesystem::path(folder) / "results.csv").native();
  return {nb::bytes(results.data(), results.size()), summary};
}

}  // namespace

void bind_sweep(nb::module_& module) {
  module.def("sweep", &run_sweep, nb::arg("json"), nb::arg("file"), nb::arg("folder"),
             nb::arg("resume"), nb::arg("progress"),
             "Runs a sweep; returns the path of results.csv and the text of summary.txt.");
}

}  // namespace beambench::python
