#pragma once
// The processor time that other processes use, which disturbs times.

#include <chrono>
#include <filesystem>
#include <optional>

namespace beambench::measure {

/// Other work that keeps more processors busy than this disturbs times.
constexpr double kQuiet = 0.1;

/// Measures how many processors other processes keep busy: the processor time that the kernel
/// counts in /proc/stat (proc_stat(5)), minus the time of this process and its ended children.
/// Unlike a load average, it does not include work that ended before.
class OtherWork {
 public:
  /// Begins to measure; /proc/stat is read below `root`.
  explicit OtherWork(const std::filesystem::path& root = "/");

  /// Returns the mean since construction. Returns nothing if less than 0.4 s have passed, because
  /// the kernel counts in hundredths of a second, or if the system does not report its time.
  std::optional<double> processors() const;

 private:
  struct Reading {
    std::chrono::steady_clock::time_point when;
    std::optional<double> all;  ///< seconds of all processors since the system started
    double own;                 ///< seconds of this process and its ended children
  };
  Reading read() const;

  std::filesystem::path root_;
  Reading begin_ = read();
};

}  // namespace beambench::measure
