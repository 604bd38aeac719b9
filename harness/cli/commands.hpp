#pragma once
// The subcommands of `beambench`, each in its own file.

#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "harness/base/messages.hpp"

namespace beambench::cli {

/// Each function adds its subcommand with options and help to `app`. If the user picks it, it runs
/// while `app` parses, and stores its result in `exit_code`, which must outlive `app`. Invalid
/// requests throw InputError.
using AddCommand = void(CLI::App& app, int& exit_code);
AddCommand add_list_command, add_scene_command, add_export_command, add_render_command,
    add_explain_command, add_rays_command, add_hits_command, add_stats_command, add_verify_command,
    add_trace_command, add_selftest_command, add_run_command, add_time_command, add_analyze_command,
    add_merge_command, add_report_command, add_fingerprint_command;
/// The experiments of the thesis (`harness/thesis`); built unless BEAMBENCH_THESIS is off.
AddCommand add_sampling_command, add_census_command, add_mirrors_command;
/// Returns the thesis's commands that were built.
std::vector<AddCommand*> thesis_commands();
/// Returns the names of all options of a command: `-o`, `--output` and so on.
std::vector<std::string> option_names(const CLI::App& command);
/// These two commands inspect the other commands of `app` when they run.
AddCommand add_completion_command, add_man_command;

}  // namespace beambench::cli
