// beambench report: starts the Python package that makes a run's plots, pictures and page.

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "harness/cli/commands.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/printable.hpp"

namespace beambench::cli {
namespace {

namespace fs = std::filesystem;

/// Runs the package, or states how to install what it lacks.
constexpr const char* kStart = R"PY(import sys
try:
    from beambench_report.__main__ import main
except ModuleNotFoundError as missing:
    print(f"beambench: {sys.executable} has no module '{missing.name}', which reports need; install it: "
          "pipx install 'beambench[report]' (in a clone of the repository: scripts/setup python)",
          file=sys.stderr)
    sys.exit(2)
sys.exit(main()))PY";

struct ReportRequest {
  std::string folder;
  std::string reference;
};

/// Returns the Python that started this program (from a wheel), otherwise the Python set up by
/// scripts/setup, otherwise the system's Python.
std::string find_python() {
  if (const char* starter = std::getenv("BEAMBENCH_REPORT_PYTHON")) return starter;
  std::error_code error;
  return fs::exists(BEAMBENCH_SOURCE_PYTHON, error) ? BEAMBENCH_SOURCE_PYTHON : "python3";
}

/// Replaces this process. Throws InputError if Python is missing.
void report(const ReportRequest& request) {
  std::vector<std::string> words{find_python(), "-c",
                                 kStart,        "report",
                                 "--beambench", fs::read_symlink("/proc/self/exe").string()};
  if (!request.reference.empty()) words.push_back("--reference=" + request.reference);
  words.emplace_back("--");
  words.push_back(request.folder);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  ::execvp(arguments[0], arguments.data());
  throw InputError(
      fmt::format("reports are drawn by Python, and {} cannot be run: {}; install "
                  "Python 3.11 or later and then: pipx install 'beambench[report]'",
                  name_of_path(words[0]), std::generic_category().message(errno)));
}

}  // namespace

void add_report_command(CLI::App& app, int& /*exit_code*/) {
  CLI::App* command =
      app.add_subcommand("report", "Draw a run's plots and pictures, and a page that shows them");
  const auto request = std::make_shared<ReportRequest>();
  command->add_option("DIR", request->folder, "The folder of a run")->required();
  command
      ->add_option("--reference", request->reference,
                   "The contender whose times are 1 in the ratios, as named in the plots; by "
                   "default, the contender with correct hits in the most views")
      ->type_name("CONTENDER");
  command->footer(
      "Writes DIR/plots, DIR/pictures and DIR/report.html, and prints the path of the page. Needs "
      "the\nPython package: pipx install 'beambench[report]', or in a clone of the repository, "
      "scripts/setup.\nIt runs in the Python named by BEAMBENCH_REPORT_PYTHON, in the "
      "installation's, or in python3.\n"
      "Examples:\n"
      "  beambench run quick -o my-run --benchmark_filter=tetra.*samet\n"
      "  beambench report my-run");
  command->callback([request] { report(*request); });
}

}  // namespace beambench::cli
