// The command line: runs a subcommand, and turns errors into one sentence and an exit code.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>  // included only here, because it generates much code
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "accel/core/threads.hpp"
#include "harness/base/messages.hpp"
#include "harness/base/process_start.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/inputs.hpp"
#include "harness/measure/block_process.hpp"
#include "harness/measure/record/machine.hpp"
#include "harness/plugin/activity.hpp"
#include "harness/plugin/load_plugin.hpp"
#include "harness/rays/hit_check.hpp"
#include "harness/verify/outside_program.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/nearest_name.hpp"
#include "scenes/base/process_memory.hpp"

namespace beambench::cli {
namespace {

constexpr const char* kDescription =
    "Compares acceleration structures for ray tracing on the same scenes, cameras and rays,\n"
    "and reports a time only when the hits are correct.";
constexpr const char* kExamples =
    "Examples:\n"
    "  beambench list\n"
    "  beambench render balls --accel samet -o balls.png\n"
    "  beambench verify tetra:n=4 --accel all\n"
    "'beambench COMMAND --help' describes a command. Exit codes: 0 success, 1 a mismatch or\n"
    "regression, 2 invalid arguments or input, 130 interrupted.";

int fail(const std::string& message, int exit_code) {
  return base::report_error("beambench", message, exit_code);
}

int fail_to_print() {
  return fail("cannot write to the standard output; free some disk space", base::kInvalidInput);
}

using Arguments = std::vector<std::string>;

/// Adds the option to --help, completions and the manual page; it has already been removed from the
/// command line.
void add_plugin_option(CLI::App& app) {
  app.add_option("--plugin", "Shared object with your own structures or scenes; may be repeated")
      ->type_name("FILE");
}

/// Throws InputError if an unknown option stands where a command is expected.
void require_known_option(const CLI::App& app, const std::string& word) {
  const std::vector<std::string> names = option_names(app);
  if (std::ranges::find(names, word.substr(0, word.find('='))) != names.end()) return;
  throw InputError(fmt::format("there is no option '{}' before a command; {}see 'beambench --help'",
                               word, did_you_mean(word, names)));
}

/// Checks the command, because CLI11 would only report that a subcommand is required or an argument
/// was not expected.
void require_known_command(const CLI::App& app, const Arguments& arguments) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  const std::string word = arguments.size() > 1 ? arguments[1] : "";
  if (word.starts_with('-')) return require_known_option(app, word);
  if (std::find(names.begin(), names.end(), word) != names.end()) return;
  const std::string_view remedy = "'beambench --help' describes them";
  if (word.empty()) {
    throw InputError(fmt::format("name a command: {}; {}", fmt::join(names, ", "), remedy));
  }
  throw InputError(fmt::format("there is no command '{}'; {}the commands are {}; {}", word,
                               did_you_mean(word, names), fmt::join(names, ", "), remedy));
}

/// Replaces `beambench help` and `beambench help render`, as in git and elsewhere, by `--help`.
void take_help_for_a_command(Arguments& arguments) {
  if (arguments.size() < 2 || arguments[1] != "help") return;
  arguments.erase(arguments.begin() + 1);
  arguments.emplace_back("--help");
}

/// Returns "did you mean '--resolution'? " for the first word that is neither an option nor an
/// argument.
std::string suggested_option(const CLI::App& command) {
  const std::vector<std::string> names = option_names(command);
  for (const std::string& word : command.remaining()) {
    if (word.starts_with('-')) return did_you_mean(word.substr(0, word.find('=')), names);
  }
  return "";
}

int parse_and_run(const Arguments& arguments) {
  CLI::App app(kDescription, "beambench");
  int exit_code = base::kSuccess;
  app.set_version_flag("--version", fmt::format("beambench {}", measure::build_info().version));
  app.footer(kExamples);
  app.get_formatter()->column_width(34);
  app.require_subcommand(1);
  for (const auto add :
       {add_list_command, add_scene_command, add_export_command, add_render_command,
        add_explain_command, add_rays_command, add_hits_command, add_stats_command,
        add_time_command, add_verify_command, add_trace_command, add_selftest_command,
        add_run_command, add_analyze_command, add_report_command, add_merge_command,
        add_fingerprint_command, add_completion_command, add_man_command}) {
    add(app, exit_code);
  }
  for (AddCommand* add : thesis_commands()) add(app, exit_code);
  add_plugin_option(app);
  try {
    require_known_command(app, arguments);
    // CLI11 takes arguments from the end of a list.
    app.parse(Arguments(arguments.rbegin(), arguments.rend() - 1));
  } catch (const CLI::Success& success) {  // --help and --version
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    const auto picked = app.get_subcommands();
    const std::string command = picked.empty() ? "" : picked.front()->get_name() + ' ';
    const std::string meant = picked.empty() ? "" : suggested_option(*picked.front());
    return fail(fmt::format("{}; {}see 'beambench {}--help'", error.what(), meant, command),
                base::kInvalidInput);
  }
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) return fail_to_print();
  return exit_code;
}

int run_command_line(const Arguments& arguments, const std::vector<std::string>& plugins,
                     plugin::Activity& activity) {
  try {
    available_memory();  // refuses an invalid BEAMBENCH_MEMORY before doing any work
    for (const std::string& file : plugins) plugin::load_plugin(file, activity);
    if (arguments.size() == 2 && arguments[1] == measure::kBlockCommand) {
      return measure::serve_block(activity);
    }
    return parse_and_run(arguments);
  } catch (const InputError& error) {
    return fail(error.what(), base::kInvalidInput);
  } catch (const verify::Interrupted& error) {
    return fail(error.what(), base::kInterrupted);
  } catch (const PluginError& error) {
    return fail(error.what(), base::kMismatch);
  } catch (const rays::InvalidHit& error) {
    return fail(error.what(), base::kMismatch);
  } catch (const std::filesystem::filesystem_error& error) {
    return fail(error.what(), base::kInvalidInput);
  } catch (const std::exception& error) {
    if (std::ferror(stdout) != 0) return fail_to_print();  // thrown while printing
    return base::report_failure("beambench", error);
  }
}

/// Returns whether the user has disabled the guard, for debuggers.
bool wants_no_guard() { return std::getenv("BEAMBENCH_UNGUARDED") != nullptr; }

/// Runs the program, in a separate process if it loads foreign code.
int begin(int argc, char** argv) {
  try {
    plugin::set_program_name(argv[0]);
    Arguments arguments(argv, argv + argc);
    const std::vector<std::string> plugins = plugin::take_requested_plugins(arguments);
    take_help_for_a_command(arguments);
    replace_renamed_options("beambench", arguments);
    std::unique_ptr<plugin::Activity> activity = plugin::guarded_activity();
    const bool guarded = activity != nullptr;
    if (!plugins.empty() && !guarded && !wants_no_guard()) return plugin::run_guarded(argv);
    if (!guarded) activity = std::make_unique<plugin::Activity>();
    int code = base::kInternalError;
    accel::on_default_threads([&] { code = run_command_line(arguments, plugins, *activity); });
    activity->clear(plugin::Activity::Line::kForeign);
    return code;
  } catch (const std::exception& error) {
    return fail(error.what(), base::kInvalidInput);
  }
}

}  // namespace
}  // namespace beambench::cli

int main(int argc, char** argv) {
  beambench::base::prepare_process();
  return beambench::cli::begin(argc, argv);
}
