#pragma once
// The control groups of this process: cgroups(7), versions 1 and 2.

#include <filesystem>
#include <string_view>
#include <vector>

namespace beambench {

/// The folders of the groups whose limits apply to this process: the innermost group first, then
/// its mounted ancestors. The two versions name their files differently.
struct ControlGroups {
  std::vector<std::filesystem::path> version1;
  std::vector<std::filesystem::path> version2;
};

/// Returns the groups of a controller, such as "cpu" or "memory". Both versions may be in use at
/// once, with each controller in one of them. A folder may lack the controller's files. In a
/// container, only the container's own group is mounted, and its mount is returned. `root` is the
/// folder that holds /proc and the mounts.
ControlGroups control_groups(std::string_view controller, const std::filesystem::path& root = "/");

}  // namespace beambench
