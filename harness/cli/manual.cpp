// beambench man: the manual page, generated from the program's options.

#include <cstdio>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "harness/bench/record/build_info.hpp"
#include "harness/cli/commands.hpp"

namespace beambench::cli {
namespace {

/// A text escaped for roff: no character is taken for a request (groff_char(7), roff(7)).
std::string escaped(std::string_view text) {
  std::string out;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      out += c;
    }
    line_begins = c == '\n';
  }
  return out;
}

/// Lines without filling.
std::string verbatim(std::string_view text) { return fmt::format(".nf\n{}\n.fi\n", escaped(text)); }

std::string bold(const std::string& word) { return R"(\fB)" + escaped(word) + R"(\fR)"; }

/// `\fB\-o\fR, \fB\-\-output\fR \fITEXT\fR`, and in the next lines what it is for.
std::string option_entry(const CLI::Option& option) {
  std::string names;
  if (option.get_positional()) {
    names = R"(\fI)" + escaped(option.get_name(true)) + R"(\fR)";
  } else {
    for (const std::string& name : option.get_snames()) names += bold("-" + name) + ", ";
    for (const std::string& name : option.get_lnames()) names += bold("--" + name) + ", ";
    names.resize(names.size() - 2);
    if (option.get_items_expected_max() > 0) names += " \\fIVALUE\\fR";
  }
  std::string about = escaped(option.get_description());
  if (!option.get_default_str().empty()) {
    about += fmt::format(" (default: {})", escaped(option.get_default_str()));
  }
  if (option.get_required()) about += " (required)";
  return fmt::format(".TP\n{}\n{}\n", names, about);
}

std::string command_section(const CLI::App& command) {
  std::string out = fmt::format(".SS beambench {}\n{}.\n", escaped(command.get_name()),
                                escaped(command.get_description()));
  for (const CLI::Option* option : command.get_options()) out += option_entry(*option);
  return out + ".PP\n" + verbatim(command.get_footer());
}

std::string manual_page(const CLI::App& app) {
  std::string out = fmt::format(
      ".TH BEAMBENCH 1 \"\" \"beambench {}\" \"User Commands\"\n"
      ".SH NAME\nbeambench \\- compares the acceleration structures of ray tracing\n"
      ".SH SYNOPSIS\n.B beambench\n\\fICOMMAND\\fR [\\fIOPTION\\fR]...\n"
      ".SH DESCRIPTION\n{}\n.SH OPTIONS\n",
      escaped(bench::build_info().version), escaped(app.get_description()));
  for (const CLI::Option* option : app.get_options()) out += option_entry(*option);
  out += ".SH COMMANDS\n";
  for (const CLI::App* command : app.get_subcommands({})) out += command_section(*command);
  return out + ".SH EXAMPLES AND EXIT STATUS\n" + verbatim(app.get_footer());
}

}  // namespace

void add_man_command(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand("man", "Print the manual page as roff");
  command->footer(
      "Where beambench is installed, 'man beambench' shows it.\n"
      "Examples:\n"
      "  beambench man > beambench.1");
  command->callback([&app] { fmt::print("{}", manual_page(app)); });
}

}  // namespace beambench::cli
