#include "harness/measure/find_sweep.hpp"

#include <algorithm>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/base/code_folder.hpp"
#include "harness/base/messages.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/nearest_name.hpp"
#include "scenes/base/printable.hpp"

namespace beambench::measure {
namespace {

namespace fs = std::filesystem;

/// Returns the folder of the sweeps installed with the program or in the Python package; if there
/// is none, the folder of the sources.
fs::path sweep_folder() {
  const fs::path code = base::code_folder();
  for (const fs::path& prefix : {code.parent_path(), code}) {
    const fs::path installed = prefix / "share/beambench/sweeps";
    std::error_code error;
    if (fs::is_directory(installed, error)) return installed;
  }
  return BEAMBENCH_SWEEPS;
}

/// Returns the name of the sweep to which a path in the former folder refers; empty for other
/// paths.
std::string former_name(const std::string& asked) {
  constexpr std::string_view kFormer = "harness/bench/sweeps/";
  const std::size_t at = asked.find(kFormer);
  if (at == std::string::npos || !asked.ends_with(".json")) return "";
  const std::size_t begin = at + kFormer.size();
  return asked.substr(begin, asked.size() - begin - std::string_view(".json").size());
}

}  // namespace

std::vector<std::string> sweep_names() {
  std::vector<std::string> names;
  const fs::path folder = sweep_folder();
  std::error_code error;
  for (const auto& entry : fs::recursive_directory_iterator(folder, error)) {
    if (entry.path().extension() != ".json") continue;
    names.push_back(fs::relative(entry.path(), folder).replace_extension().string());
  }
  std::ranges::sort(names);
  return names;
}

fs::path find_sweep(const std::string& asked) {
  std::error_code error;
  if (fs::exists(asked, error)) return asked;
  const std::vector<std::string> names = sweep_names();
  const std::string former = former_name(asked);
  if (former.empty() && asked.ends_with(".json")) return asked;  // its reader reports the error
  const std::string& name = former.empty() ? asked : former;
  if (std::ranges::find(names, name) == names.end()) {
    throw InputError(
        fmt::format("{}: there is no such file, and no sweep of that name; {}name a "
                    "JSON file or one of {}",
                    name_of_path(asked), did_you_mean(asked, names), fmt::join(names, ", ")));
  }
  if (!former.empty()) {
    base::report_error("beambench",
                       fmt::format("{} has moved to harness/measure/sweeps; name it '{}'",
                                   name_of_path(asked), name),
                       base::kSuccess);
  }
  return sweep_folder() / (name + ".json");
}

}  // namespace beambench::measure
