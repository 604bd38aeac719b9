// The command line: picks a subcommand, and turns whatever goes wrong into one sentence and an exit
// code.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/cli/commands.hpp"
#include "harness/record/build_info.hpp"
#include "scenes/error.hpp"
#include "scenes/nearest_name.hpp"

namespace beambench {
namespace {

constexpr const char* kDescription =
    "Compares the acceleration structures of ray tracing on the same scenes, cameras and rays,\n"
    "and lets no timing out that the hits do not back.";
constexpr const char* kExamples =
    "Examples:\n"
    "  beambench list\n"
    "  beambench render balls --accel samet -o balls.png\n"
    "  beambench verify tetra:n=4 --accel all\n"
    "'beambench COMMAND --help' tells more. Exit codes: 0 fine, 1 a mismatch or regression was\n"
    "found, 2 the request was wrong, 130 interrupted.";

/// One line, whatever the message was made of.
int complain(std::string message, int exit_code) {
  for (char& c : message) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  while (!message.empty() && message.back() == ' ') message.pop_back();
  fmt::print(stderr, "beambench: {}\n", message);
  return exit_code;
}

int complain_of_output() {
  return complain("cannot write to the standard output; make room where it goes", kWrongRequest);
}

/// CLI11 would only say that a subcommand is required, or that an argument was not expected.
void require_known_command(const CLI::App& app, int argc, char** argv) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  const std::string word = argc > 1 ? argv[1] : "";
  if (word.starts_with('-')) return;
  if (std::find(names.begin(), names.end(), word) != names.end()) return;
  const std::string_view remedy = "'beambench --help' tells what they do";
  if (word.empty()) {
    throw InputError(fmt::format("name a command: {}; {}", fmt::join(names, ", "), remedy));
  }
  throw InputError(
      fmt::format("there is no command '{}'; did you mean '{}'? The commands are {}; {}", word,
                  nearest_name(word, names), fmt::join(names, ", "), remedy));
}

int parse_and_run(int argc, char** argv) {
  CLI::App app(kDescription, "beambench");
  int exit_code = kSuccess;
  app.set_version_flag("--version", fmt::format("beambench {}", build_info().version));
  app.footer(kExamples);
  app.get_formatter()->column_width(34);
  app.require_subcommand(1);
  for (const auto add :
       {add_list_command, add_scene_command, add_export_command, add_render_command,
        add_rays_command, add_stats_command, add_verify_command, add_trace_command, add_run_command,
        add_sampling_command, add_census_command, add_mirrors_command, add_completion_command,
        add_man_command}) {
    add(app, exit_code);
  }
  try {
    require_known_command(app, argc, argv);
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {  // --help and --version
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    const auto picked = app.get_subcommands();
    const std::string command = picked.empty() ? "" : picked.front()->get_name() + ' ';
    return complain(fmt::format("{}; see 'beambench {}--help'", error.what(), command),
                    kWrongRequest);
  }
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) return complain_of_output();
  return exit_code;
}

int run_command_line(int argc, char** argv) {
  try {
    return parse_and_run(argc, argv);
  } catch (const InputError& error) {
    return complain(error.what(), kWrongRequest);
  } catch (const std::bad_alloc&) {
    return complain(
        "the memory does not suffice for this request; choose a smaller scene, resolution or "
        "structure",
        kWrongRequest);
  } catch (const std::filesystem::filesystem_error& error) {
    return complain(error.what(), kWrongRequest);
  } catch (const std::exception& error) {
    if (std::ferror(stdout) != 0) return complain_of_output();  // thrown while printing
    return complain(
        fmt::format("internal error, please report it with the command line: {}", error.what()),
        kInternalError);
  }
}

}  // namespace
}  // namespace beambench

int main(int argc, char** argv) { return beambench::run_command_line(argc, argv); }
