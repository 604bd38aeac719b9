// beambench merge: joins the shards of a sweep.

#include "harness/analysis/merge.hpp"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "harness/analysis/words.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/interruption.hpp"

namespace beambench::cli {
namespace {

struct MergeRequest {
  std::vector<std::string> shards;
  std::string output;
};

int merge(const MergeRequest& request) {
  const Interruption interruption("interrupted; nothing was written, and the shards are unchanged");
  const std::vector<std::filesystem::path> shards(request.shards.begin(), request.shards.end());
  const analysis::Analysis found = analysis::merge_shards(shards, request.output, stderr);
  fmt::print(stderr, "\n{}", analysis::summary(found));
  fmt::print("{}\n", (std::filesystem::path(request.output) / "results.csv").string());
  return analysis::exit_code_of(found);
}

}  // namespace

void add_merge_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("merge", "Join the shards of a sweep, measured by 'run --shard'");
  const auto request = std::make_shared<MergeRequest>();
  command->add_option("DIR", request->shards, "The folders of all shards, in any order")
      ->required();
  command
      ->add_option("-o,--output", request->output,
                   "Folder for the record of the whole sweep; it must not exist yet")
      ->required();
  command->footer(
      "Each row states the machine on which it was measured; times of different machines are not "
      "compared.\n"
      "Examples:\n"
      "  beambench run quick --shard 1/2 -o first\n"
      "  beambench run quick --shard 2/2 -o second\n"
      "  beambench merge first second -o whole");
  command->callback([request, &exit_code] { exit_code = merge(*request); });
}

}  // namespace beambench::cli
