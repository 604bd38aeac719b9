#pragma once
// Progress of a long job, with its remaining time.

#include <chrono>
#include <cstdio>
#include <string>
#include <string_view>

namespace beambench::base {

/// Returns "7 s", "3 min 20 s", "2 h 5 min".
std::string format_duration(double seconds);

/// Reports a job of several cells on a stream (stderr). On a terminal one line is redrawn: the
/// number of cells done, the current cell, and the remaining time estimated from the pace so far.
/// Elsewhere, one line is printed for each finished cell. Not thread-safe.
class Progress {
 public:
  /// The cells may take different times; if the times differ greatly, report the work done to
  /// `advance`.
  explicit Progress(std::size_t cells, std::FILE* stream = stderr);
  Progress(std::size_t cells, std::FILE* stream, bool terminal);
  /// Clears the line.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Begins a cell; `name` is shown.
  void start(std::string_view name);
  /// Updates the share of the current cell that is done (0 ... 1). Cheap: redraws at most a few
  /// times per second.
  void advance(double part);
  /// Finishes the current cell; its line shows the name, then `result`.
  void finish(std::string_view result);
  /// Leaves out a number of cells that will not be run.
  void skip(std::size_t cells);
  /// Prints a separate line (a warning, a result) without disturbing the progress line.
  void say(std::string_view line);
  /// Wipes the progress line before something else writes to the terminal.
  void clear();

  bool on_terminal() const { return terminal_; }

 private:
  using Clock = std::chrono::steady_clock;
  void draw(double part);

  std::FILE* stream_;
  bool terminal_;
  std::size_t cells_;
  std::size_t done_ = 0;
  std::string name_;
  bool drawn_ = false;
  Clock::time_point begin_;
  Clock::time_point last_draw_;
};

/// Returns the remaining seconds if `part` (0 ... 1] of the work took `elapsed` seconds.
double remaining_seconds(double elapsed, double part);

}  // namespace beambench::base
