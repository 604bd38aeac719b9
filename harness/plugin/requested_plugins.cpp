#include "harness/plugin/requested_plugins.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "scenes/core/error.hpp"

namespace beambench::plugin {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kOption = "--plugin";
constexpr const char* kVariable = "BEAMBENCH_PLUGINS";

void add_once(std::vector<std::string>& files, std::string file) {
  if (std::ranges::find(files, file) == files.end()) files.push_back(std::move(file));
}

void add_folder(std::vector<std::string>& files, const fs::path& folder) {
  std::vector<std::string> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".so") found.push_back(entry.path().string());
  }
  std::ranges::sort(found);
  for (std::string& file : found) add_once(files, std::move(file));
}

void add_from_environment(std::vector<std::string>& files) {
  const char* text = std::getenv(kVariable);
  std::string_view rest = text == nullptr ? "" : text;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    const std::string entry(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    std::error_code error;
    if (fs::is_directory(entry, error)) {
      add_folder(files, entry);
    } else if (!entry.empty()) {
      add_once(files, entry);
    }
  }
}

}  // namespace

std::vector<std::string> take_requested_plugins(std::vector<std::string>& arguments) {
  std::vector<std::string> files;
  add_from_environment(files);
  std::vector<std::string> left;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    if (argument == "--") {
      left.insert(left.end(), arguments.begin() + static_cast<std::ptrdiff_t>(i), arguments.end());
      break;
    }
    if (argument.starts_with("--plugin=")) {
      add_once(files, argument.substr(std::string_view("--plugin=").size()));
    } else if (argument == kOption) {
      if (++i == arguments.size()) {
        throw InputError(
            "--plugin needs a file: the shared object that beambench_add_plugin built");
      }
      add_once(files, arguments[i]);
    } else {
      left.push_back(argument);
    }
  }
  arguments = std::move(left);
  return files;
}

}  // namespace beambench::plugin
