// beambench analyze: draws the conclusions from the log of a run.

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "harness/analysis/exports.hpp"
#include "harness/analysis/words.hpp"
#include "harness/cli/commands.hpp"
#include "harness/measure/record/run_log.hpp"
#include "scenes/base/json_text.hpp"

namespace beambench::cli {
namespace {

struct AnalyzeRequest {
  std::string folder;
  bool write = false;
  bool json = false;
};

int analyze(const AnalyzeRequest& request) {
  const std::filesystem::path folder = request.folder;
  const analysis::Analysis found =
      request.write ? analysis::conclude(folder)
                    : read_as_written((folder / measure::kLogName).string(), "measure it again",
                                      [&] { return analysis::analyze(measure::read_run(folder)); });
  if (request.json) {
    fmt::print("{}\n", json_text(analysis::to_json(found)));
  } else {
    fmt::print("{}{}", analysis::describe_contenders(found.views), analysis::summary(found));
  }
  return analysis::exit_code_of(found);
}

}  // namespace

void add_analyze_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "analyze",
      "State what a run shows: which structure is fastest, and how reliable the times are");
  const auto request = std::make_shared<AnalyzeRequest>();
  command->add_option("DIR", request->folder, "The folder of a run; it may have been interrupted")
      ->required();
  command->add_flag("--write", request->write,
                    "Write results.csv, summary.txt, analysis.json and the other files of the "
                    "folder from its log, run.jsonl");
  command->add_flag("--json", request->json, "Print JSON: the content of analysis.json");
  command->footer(
      "Examples:\n"
      "  beambench run quick -o my-run --benchmark_filter=tetra.*samet\n"
      "  beambench analyze my-run\n"
      "  beambench analyze my-run --write");
  command->callback([request, &exit_code] { exit_code = analyze(*request); });
}

}  // namespace beambench::cli
