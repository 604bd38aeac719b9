#include "scenes/base/control_groups.hpp"

#include <algorithm>
#include <optional>
#include <string>

#include "scenes/base/kernel_text.hpp"

namespace beambench {
namespace {

namespace fs = std::filesystem;

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t end = std::min(text.find(separator), text.size());
    parts.push_back(text.substr(0, end));
    if (end == text.size()) return parts;
    text.remove_prefix(end + 1);
  }
}

bool lists(std::string_view names, std::string_view name) {
  const std::vector<std::string_view> parts = split(names, ',');
  return std::ranges::find(parts, name) != parts.end();
}

/// Unescapes `\040` to a blank, and so on: proc(5) escapes blanks, tabs, line ends and backslashes.
std::string unescaped(std::string_view text) {
  constexpr std::size_t kDigits = 3;
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::string_view digits = text.substr(i + 1, kDigits);
    const bool is_escape = text[i] == '\\' && digits.size() == kDigits &&
                           digits.find_first_not_of("01234567") == std::string_view::npos;
    if (!is_escape) {
      result += text[i];
      continue;
    }
    result += static_cast<char>(64 * (digits[0] - '0') + 8 * (digits[1] - '0') + digits[2] - '0');
    i += kDigits;
  }
  return result;
}

/// The process's group in each hierarchy, as a path from the root; empty if the process is in no
/// group.
struct Membership {
  std::optional<std::string> version1;
  std::optional<std::string> version2;
};

/// Reads lines like `4:cpu,cpuacct:/user.slice` and `0::/user.slice`.
Membership membership(std::string_view controller, const fs::path& root) {
  Membership found;
  const std::string text = kernel_text(root / "proc/self/cgroup");
  for (const std::string_view line : split(text, '\n')) {
    const std::size_t first = line.find(':');
    const std::size_t second = first < line.size() ? line.find(':', first + 1) : first;
    if (second == std::string_view::npos) continue;
    const std::string_view controllers = line.substr(first + 1, second - first - 1);
    const std::string path(line.substr(second + 1));
    if (controllers.empty()) found.version2 = path;
    if (lists(controllers, controller)) found.version1 = path;
  }
  return found;
}

/// Returns the path of a group below the mounted group, or an empty path if only the mount is
/// visible.
fs::path below_mount(const std::string& group, const std::string& mounted) {
  const fs::path relative = fs::path(group).lexically_relative(mounted);
  const bool is_below = !relative.empty() && std::ranges::find(relative, "..") == relative.end();
  return is_below && relative != "." ? relative : fs::path();
}

void add_folders(std::vector<fs::path>& folders, const fs::path& mount, fs::path below) {
  for (; !below.empty(); below = below.parent_path()) folders.push_back(mount / below);
  folders.push_back(mount);
}

}  // namespace

ControlGroups control_groups(std::string_view controller, const fs::path& root) {
  // `36 35 0:29 / /sys/fs/cgroup/cpu rw,relatime - cgroup cgroup rw,cpu` (proc(5)): the mounted
  // group, the mount point, and after a dash the type, the source and the options.
  constexpr std::size_t kMounted = 3;
  constexpr std::size_t kPoint = 4;
  constexpr std::size_t kMinBeforeDash = 6;
  ControlGroups groups;
  const Membership own = membership(controller, root);
  const std::string mounts = kernel_text(root / "proc/self/mountinfo");
  for (const std::string_view line : split(mounts, '\n')) {
    const std::vector<std::string_view> words = split(line, ' ');
    if (words.size() < kMinBeforeDash) continue;
    const auto dash = std::find(words.begin() + kMinBeforeDash, words.end(), "-");
    if (words.end() - dash < 4) continue;
    const fs::path mount = root / fs::path(unescaped(words[kPoint])).relative_path();
    const std::string mounted = unescaped(words[kMounted]);
    if (own.version2 && dash[1] == "cgroup2") {
      add_folders(groups.version2, mount, below_mount(*own.version2, mounted));
    } else if (own.version1 && dash[1] == "cgroup" && lists(dash[3], controller)) {
      add_folders(groups.version1, mount, below_mount(*own.version1, mounted));
    }
  }
  return groups;
}

}  // namespace beambench
