// beambench completion: a shell's script, generated from the program's options.

#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "accel/core/registry.hpp"
#include "harness/cli/commands.hpp"
#include "harness/rays/ray_kind.hpp"
#include "harness/render/diagnostics.hpp"
#include "harness/render/shading.hpp"
#include "harness/render/whitted_options.hpp"
#include "scenes/catalogue.hpp"

namespace beambench::cli {
namespace {

using Words = std::vector<std::string>;

Words structure_names(std::string extra) {
  Words names{std::move(extra)};
  for (const accel::StructureInfo& info : accel::registry().structures())
    names.push_back(info.name);
  return names;
}

Words scene_names() {
  Words names;
  for (const scenes::SceneInfo& info : scenes::scene_catalogue()) names.push_back(info.name);
  return names;
}

Words ray_kind_names() {
  Words names;
  for (const rays::RayKindInfo& info : rays::ray_kinds()) names.emplace_back(info.name);
  return names;
}

/// The names that 'beambench list' takes.
Words listed_names() {
  Words names;
  for (const accel::StructureInfo& info : accel::registry().structures())
    names.push_back(info.name);
  for (const Words& more : {scene_names(), ray_kind_names()}) {
    names.insert(names.end(), more.begin(), more.end());
  }
  return names;
}

/// The valid values of options by their name; file names for all others.
const std::map<std::string, Words>& known_values() {
  static const std::map<std::string, Words> values{
      {"SCENE", scene_names()},
      {"NAME", listed_names()},
      {"SHELL", {"bash", "zsh", "fish"}},
      {"--accel", structure_names("all")},
      {"--difference", structure_names(render::kOracleName)},
      {"--heatmap", {accel::kCounterNames.begin(), accel::kCounterNames.end()}},
      {"--overlay", {render::overlay_names().begin(), render::overlay_names().end()}},
      {"--rays", ray_kind_names()},
      {"--rules", {"spd", "image"}},
      {"--shadows", {render::shadow_method_names().begin(), render::shadow_method_names().end()}},
      {"--shade", {render::shading_names().begin(), render::shading_names().end()}}};
  return values;
}

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

/// `-o`, `--output`.
Words names_of(const CLI::Option& option) {
  Words names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

Words option_names(const CLI::App& command) {
  Words names;
  for (const CLI::Option* option : command.get_options()) {
    for (std::string& name : names_of(*option)) names.push_back(std::move(name));
  }
  return names;
}

Words command_names(const CLI::App& app) {
  Words names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

/// The words for a command's arguments that are no options.
Words argument_words(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    const auto known = known_values().find(option->get_name(true));
    if (option->get_positional() && known != known_values().end()) return known->second;
  }
  return {};
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
  return fmt::format(
      "_beambench() {{\n"
      "  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} words=''\n"
      "  if [[ $COMP_CWORD -eq 1 ]]; then\n"
      "    words='{}'\n"
      "  elif [[ $word == -* ]]; then\n"
      "    case ${{COMP_WORDS[1]}} in\n"
      "{}"
      "    esac\n"
      "  elif [[ $before == -* ]]; then  # a value: a word that is known, or a file\n"
      "    case $before in\n"
      "{}"
      "    esac\n"
      "  else\n"
      "    case ${{COMP_WORDS[1]}} in\n"
      "{}"
      "    esac\n"
      "  fi\n"
      "  COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
      "}}\n"
      "complete -o default -F _beambench beambench\n",
      fmt::join(first, " "), options, values, arguments);
}

/// zsh runs bash's completions. The first completion loads the script as a function, which must
/// complete, too.
std::string zsh_script(const CLI::App& app) {
  return "#compdef beambench\nautoload -U +X bashcompinit && bashcompinit\n" + bash_script(app) +
         "if [[ -n ${compstate+loading} ]]; then _bash_complete -o default -F _beambench; fi\n";
}

/// In single quotes for fish, on one line.
std::string fish_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') quoted += '\\';
    quoted += c == '\n' ? ' ' : c;
  }
  return quoted + '\'';
}

std::string fish_option(const CLI::Option& option, const std::string& condition) {
  std::string line = "complete -c beambench" + condition;
  if (option.get_positional()) {
    const auto known = known_values().find(option.get_name(true));
    if (known == known_values().end()) return "";
    return fmt::format("{} -a '{}'\n", line, fmt::join(known->second, " "));
  }
  for (const std::string& name : option.get_snames()) line += " -s " + name;
  for (const std::string& name : option.get_lnames()) line += " -l " + name;
  if (takes_value(option)) {
    line += " -r";
    const auto known = known_values().find(names_of(option).back());
    if (known != known_values().end())
      line += fmt::format(" -f -a '{}'", fmt::join(known->second, " "));
  }
  return line + " -d " + fish_quoted(option.get_description()) + '\n';
}

std::string fish_script(const CLI::App& app) {
  std::string script;
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

}  // namespace

void add_completion_command(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand("completion", "Print a shell's completion script");
  const auto shell = std::make_shared<std::string>();
  command->add_option("SHELL", *shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember(known_values().at("SHELL")));
  command->footer(
      "Where beambench is installed, so are the scripts. From a build folder, for this session:\n"
      "  eval \"$(beambench completion bash)\"\n"
      "Examples:\n"
      "  beambench completion bash\n"
      "  beambench completion fish");
  command->callback([shell, &app] { fmt::print("{}", script_for(*shell, app)); });
}

}  // namespace beambench::cli
