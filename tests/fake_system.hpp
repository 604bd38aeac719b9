#pragma once

#include <filesystem>
#include <string>

#include "tests/temporary_folder.hpp"

namespace beambench {

/// A folder that serves as the root of a system, with or without /proc and control groups.
class FakeSystem {
 public:
  const std::filesystem::path& root() const { return folder_.path(); }

  void write(const std::string& path, const std::string& text) const {
    std::filesystem::create_directories((folder_.path() / path).parent_path());
    folder_.write(path, text);
  }

  /// Puts the process into a control group of version 2, with the whole hierarchy mounted.
  void join_group(const std::string& group) const {
    write("proc/self/cgroup", "0::" + group + "\n");
    write("proc/self/mountinfo",
          "25 1 0:22 / / rw - overlay overlay rw\n"
          "31 25 0:26 / /sys/fs/cgroup rw,nosuid shared:9 - cgroup2 cgroup2 rw,nsdelegate\n");
  }

  /// Sets the counts in cpu.stat of a control group of version 2.
  void count_throttling(const std::string& group, int periods, int throttled) const {
    write("sys/fs/cgroup" + group + "/cpu.stat",
          "usage_usec 900000\nnr_periods " + std::to_string(periods) + "\nnr_throttled " +
              std::to_string(throttled) + "\nthrottled_usec " + std::to_string(80000 * throttled) +
              "\n");
  }

 private:
  TemporaryFolder folder_;
};

}  // namespace beambench
