// beambench completion, beambench man: generated from the program's options.

#include <array>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "accel/core/registry.hpp"
#include "harness/cli/commands.hpp"
#include "harness/measure/record/machine.hpp"
#include "harness/rays/ray_kind.hpp"
#include "harness/render/diagnostics.hpp"
#include "harness/render/shading.hpp"
#include "harness/render/shadows.hpp"
#include "harness/render/structure_overlay.hpp"
#include "scenes/catalogue.hpp"

namespace beambench::cli {
namespace {

using Words = std::vector<std::string>;

/// Returns `first`, then the names of structures, scenes or kinds of rays.
template <class... Infos>
Words names_with(Words first, const Infos&... all) {
  const auto add = [&](const auto& infos) {
    for (const auto& info : infos) first.push_back(info.name);
  };
  (add(all), ...);
  return first;
}

/// Returns the valid values of options, by option; other options take file names.
const std::map<std::string, Words>& known_values() {
  const auto structures = accel::registry().structures();
  static const std::map<std::string, Words> values{
      {"SCENE", names_with({}, scenes::scene_catalogue())},
      {"NAME", names_with({}, structures, scenes::scene_catalogue(), rays::ray_kinds())},
      {"SHELL", {"bash", "zsh", "fish"}},
      {"--accel", names_with({"all"}, structures)},
      {"--difference", names_with({render::kOracleName}, structures)},
      {"--exposure", {"auto"}},
      {"--heatmap", {accel::kCounterNames.begin(), accel::kCounterNames.end()}},
      {"--overlay", {render::overlay_names().begin(), render::overlay_names().end()}},
      {"--rays", names_with({}, rays::ray_kinds())},
      {"--rules", {"spd", "image"}},
      {"--shadows", {render::shadow_method_names().begin(), render::shadow_method_names().end()}},
      {"--shade", {render::shading_names().begin(), render::shading_names().end()}}};
  return values;
}

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

/// Returns `-o`, `--output`.
Words names_of(const CLI::Option& option) {
  Words names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

Words command_names(const CLI::App& app) {
  Words names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

/// Returns the words for a command's non-option arguments.
Words argument_words(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    const auto known = known_values().find(option->get_name(true));
    if (option->get_positional() && known != known_values().end()) return known->second;
  }
  return {};
}

/// Returns a case for each name that has parameters; the case adds them to the words. `line` has
/// placeholders for the name and for its parameters.
std::string parameter_cases(fmt::format_string<std::string, std::string> line) {
  std::string cases;
  const auto add = [&](const auto& infos) {
    for (const auto& info : infos) {
      if (info.parameters.empty()) continue;
      Words names;
      for (const ParameterInfo& parameter : info.parameters) names.push_back(parameter.name + '=');
      cases += fmt::format(line, std::string(info.name), fmt::format("{}", fmt::join(names, " ")));
    }
  };
  add(accel::registry().structures());
  add(scenes::scene_catalogue());
  add(rays::ray_kinds());
  return cases;
}

std::string bash_script(const CLI::App& app) {
  std::string options;
  std::string arguments;
  for (const CLI::App* command : app.get_subcommands({})) {
    const std::string& name = command->get_name();
    options +=
        fmt::format("      {}) words='{}' ;;\n", name, fmt::join(option_names(*command), " "));
    const Words words = argument_words(*command);
    if (words.empty()) continue;
    arguments += fmt::format("      {}) words='{}' ;;\n", name, fmt::join(words, " "));
  }
  std::string values;
  for (const auto& [name, words] : known_values()) {
    if (!name.starts_with('-')) continue;
    values += fmt::format("      {}) words='{}' ;;\n", name, fmt::join(words, " "));
  }
  Words first = command_names(app);
  for (std::string& name : option_names(app)) first.push_back(std::move(name));
  // The shell also divides words at colons, so the word is taken from the line. In a list,
  // completions repeat the part before the last comma or colon, except what the shell keeps itself.
  return fmt::format(
      "_beambench() {{\n"
      "  local line=${{COMP_LINE:0:$COMP_POINT}} words='' command='' before='' token\n"
      "  local word=${{line##* }} part kept name\n"
      "  for token in $(printf '%s' \"${{line%\"$word\"}}\"); do\n"
      "    if [[ -z $command && -n $before && $before != --plugin && $token != -* ]]; then\n"
      "      command=$token\n"
      "    fi\n"
      "    before=$token\n"
      "  done\n"
      "  part=${{word##*,}}\n"
      "  kept=${{word%\"$part\"}}\n"
      "  name=${{word%%:*}}\n"
      "  if [[ $before == --plugin ]]; then\n"
      "    words=''\n"
      "  elif [[ -z $command ]]; then\n"
      "    words='{}'\n"
      "  elif [[ $word == -* ]]; then\n"
      "    case $command in\n"
      "{}"
      "    esac\n"
      "  elif [[ $before == -* ]]; then  # a value: a word that is known, or a file\n"
      "    case $before in\n"
      "{}"
      "    esac\n"
      "  else\n"
      "    case $command in\n"
      "{}"
      "    esac\n"
      "  fi\n"
      "  if [[ $word == *:* ]]; then  # parameters of the name before the last colon\n"
      "    name=${{word%:*}}\n"
      "    name=${{name##*,}}\n"
      "    [[ $part == *:* ]] && kept=${{word%\"${{part#*:}}\"}} part=${{part#*:}} words=''\n"
      "    case $name in\n"
      "{}"
      "    esac\n"
      "  fi\n"
      "  COMPREPLY=($(compgen -P \"$kept\" -W \"$words\" -- \"$part\"))\n"
      "  if [[ $word == *:* && ${{COMP_WORDBREAKS-}} == *:* ]]; then\n"
      "    COMPREPLY=(\"${{COMPREPLY[@]#\"${{word%:*}}\":}}\")\n"
      "  fi\n"
      "  [[ ${{COMPREPLY[0]-}} != *= ]] || compopt -o nospace 2>/dev/null\n"
      "}}\n"
      "complete -o default -F _beambench beambench\n",
      fmt::join(first, " "), options, values, arguments,
      parameter_cases("      {}) words=\"$words {}\" ;;\n"));
}

/// Returns the zsh script, which runs bash's completions. The first completion loads the script as
/// a function, and must also produce completions.
std::string zsh_script(const CLI::App& app) {
  return "#compdef beambench\nautoload -U +X bashcompinit && bashcompinit\n" + bash_script(app) +
         "if [[ -n ${compstate+loading} ]]; then _bash_complete -o default -F _beambench; fi\n";
}

/// Quotes a string for fish, on one line.
std::string fish_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') quoted += '\\';
    quoted += c == '\n' ? ' ' : c;
  }
  return quoted + '\'';
}

/// Returns the function that completes the last part of a list, or a parameter. The shell replaces
/// the whole word, so the text before that part is repeated.
std::string fish_function() {
  return fmt::format(
      "function __beambench_words\n"
      "  set -l word (commandline -ct)\n"
      "  set -l words $argv\n"
      "  set -l part (string replace -r '.*,' '' -- \"$word\")\n"
      "  set -l kept (string replace -r '[^,]*$' '' -- \"$word\")\n"
      "  if string match -q '*:*' -- \"$word\"  # parameters of the name before the last colon\n"
      "    if string match -q '*:*' -- \"$part\"\n"
      "      set words\n"
      "      set kept $kept(string replace -r ':.*' ':' -- \"$part\")\n"
      "    end\n"
      "    switch (string replace -r ':[^:]*$' '' -- \"$word\" | string replace -r '.*,' '')\n"
      "{}"
      "    end\n"
      "  end\n"
      "  test -n \"$words\"; and printf '%s\\n' $kept$words\n"
      "end\n",
      parameter_cases("      case {}\n        set -a words {}\n"));
}

/// Returns `-a` with the words.
std::string fish_words(const Words& words) {
  return fmt::format(" -a '(__beambench_words {})'", fmt::join(words, " "));
}

std::string fish_option(const CLI::Option& option, const std::string& condition) {
  std::string line = "complete -c beambench" + condition;
  if (option.get_positional()) {
    const auto known = known_values().find(option.get_name(true));
    if (known == known_values().end()) return "";
    return line + fish_words(known->second) + '\n';
  }
  for (const std::string& name : option.get_snames()) line += " -s " + name;
  for (const std::string& name : option.get_lnames()) line += " -l " + name;
  if (takes_value(option)) {
    line += " -r";
    const auto known = known_values().find(names_of(option).back());
    if (known != known_values().end()) line += " -f" + fish_words(known->second);
  }
  return line + " -d " + fish_quoted(option.get_description()) + '\n';
}

std::string fish_script(const CLI::App& app) {
  std::string script = fish_function();
  for (const CLI::Option* option : app.get_options()) {
    script += fish_option(*option, " -n __fish_use_subcommand");
  }
  for (const CLI::App* command : app.get_subcommands({})) {
    script += fmt::format("complete -c beambench -n __fish_use_subcommand -f -a {} -d {}\n",
                          command->get_name(), fish_quoted(command->get_description()));
    const std::string condition =
        fmt::format(" -n '__fish_seen_subcommand_from {}'", command->get_name());
    for (const CLI::Option* option : command->get_options()) {
      script += fish_option(*option, condition);
    }
  }
  return script;
}

std::string script_for(const std::string& shell, const CLI::App& app) {
  if (shell == "zsh") return zsh_script(app);
  if (shell == "fish") return fish_script(app);
  return bash_script(app);
}

/// Escapes a string for roff, so that no character is interpreted as a request (groff_char(7),
/// roff(7)).
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

/// Returns lines that roff does not fill.
std::string verbatim(std::string_view text) { return fmt::format(".nf\n{}\n.fi\n", escaped(text)); }

std::string bold(const std::string& word) { return R"(\fB)" + escaped(word) + R"(\fR)"; }

/// Returns `\fB\-o\fR, \fB\-\-output\fR \fITEXT\fR` and, on the next lines, the description.
std::string option_entry(const CLI::Option& option) {
  std::string names;
  if (option.get_positional()) {
    names = R"(\fI)" + escaped(option.get_name(true)) + R"(\fR)";
  } else {
    for (const std::string& name : names_of(option)) names += bold(name) + ", ";
    names.resize(names.size() - 2);
    if (takes_value(option)) names += fmt::format(" \\fI{}\\fR", escaped(option.get_type_name()));
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

/// The environment variables that the program reads.
constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kEnvironment{{
    {"BEAMBENCH_MEMORY",
     "Amount of memory the program may use, such as 800M or 12G; by default, as much as the system "
     "and its control groups allow."},
    {"BEAMBENCH_PLUGINS",
     "Shared objects to load before any command, as with --plugin; multiple files are separated by "
     "colons."},
    {"BEAMBENCH_UNGUARDED", "If set, plug-ins run in the process of the program, for debuggers."},
    {"BEAMBENCH_CACHE",
     "The folder for installed meshes and for data read from meshes, instead of "
     "$XDG_CACHE_HOME/beambench."},
    {"TMPDIR", "The folder for temporary files, instead of /tmp."},
    {"XDG_CACHE_HOME", "The folder for all caches, instead of ~/.cache."},
}};

std::string manual_page(const CLI::App& app) {
  std::string out = fmt::format(
      ".TH BEAMBENCH 1 \"\" \"beambench {}\" \"User Commands\"\n"
      ".SH NAME\nbeambench \\- compares the acceleration structures of ray tracing\n"
      ".SH SYNOPSIS\n.B beambench\n\\fICOMMAND\\fR [\\fIOPTION\\fR]...\n"
      ".SH DESCRIPTION\n{}\n.SH OPTIONS\n",
      escaped(measure::build_info().version), escaped(app.get_description()));
  for (const CLI::Option* option : app.get_options()) out += option_entry(*option);
  out += ".SH COMMANDS\n";
  for (const CLI::App* command : app.get_subcommands({})) out += command_section(*command);
  out += ".SH ENVIRONMENT\n";
  for (const auto& [name, meaning] : kEnvironment) {
    out += fmt::format(".TP\n{}\n{}\n", bold(std::string(name)), escaped(meaning));
  }
  return out + ".SH EXAMPLES AND EXIT STATUS\n" + verbatim(app.get_footer());
}

}  // namespace

std::vector<std::string> option_names(const CLI::App& command) {
  Words names;
  for (const CLI::Option* option : command.get_options()) {
    for (std::string& name : names_of(*option)) names.push_back(std::move(name));
  }
  return names;
}

void add_completion_command(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand("completion", "Print a shell's completion script");
  const auto shell = std::make_shared<std::string>();
  command->add_option("SHELL", *shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember(known_values().at("SHELL")));
  command->footer(
      "Installing beambench also installs the scripts. From a build folder, for this session:\n"
      "  eval \"$(beambench completion bash)\"\n"
      "Examples:\n"
      "  beambench completion bash\n"
      "  beambench completion fish");
  command->callback([shell, &app] { fmt::print("{}", script_for(*shell, app)); });
}

void add_man_command(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand("man", "Print the manual page as roff");
  command->footer(
      "After installing beambench, 'man beambench' shows it.\n"
      "Examples:\n"
      "  beambench man > beambench.1");
  command->callback([&app] { fmt::print("{}", manual_page(app)); });
}

}  // namespace beambench::cli
