#pragma once
// The subcommands of `beambench`, one file each.

#include <CLI/App.hpp>

#include "harness/base/exit_code.hpp"
#include "harness/plugin/activity.hpp"

namespace beambench::cli {

/// Each adds its subcommand with options and help to `app`; when the user picks it, it runs while
/// `app` parses and leaves its result in `exit_code`, which outlives `app`. Wrong requests are
/// thrown as InputError.
void add_list_command(CLI::App& app, int& exit_code);
void add_scene_command(CLI::App& app, int& exit_code);
void add_export_command(CLI::App& app, int& exit_code);
void add_render_command(CLI::App& app, int& exit_code);
void add_rays_command(CLI::App& app, int& exit_code);
void add_stats_command(CLI::App& app, int& exit_code);
void add_verify_command(CLI::App& app, int& exit_code);
void add_trace_command(CLI::App& app, int& exit_code);
/// `activity` outlives `app`.
void add_run_command(CLI::App& app, int& exit_code, plugin::Activity& activity);
void add_sampling_command(CLI::App& app, int& exit_code);
void add_census_command(CLI::App& app, int& exit_code);
void add_mirrors_command(CLI::App& app, int& exit_code);
void add_selftest_command(CLI::App& app, int& exit_code);
/// These two read the other commands off `app` when they run.
void add_completion_command(CLI::App& app, int& exit_code);
void add_man_command(CLI::App& app, int& exit_code);

}  // namespace beambench::cli
