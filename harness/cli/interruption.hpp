#pragma once
// Ctrl-C and SIGTERM.

#include <csignal>
#include <mutex>
#include <string>
#include <thread>

namespace beambench::cli {

/// While it lives, SIGINT and SIGTERM end the process at once, whatever it is doing, with exit code
/// 130 and one last line on stderr. For work whose results are safe against a kill at any moment.
///
/// The signals are blocked and a thread of its own waits for them, so what it does then is not
/// limited to what a signal handler may do, and no state is global. Make it before other threads
/// are started, which inherit that they are blocked.
class Interruption {
 public:
  explicit Interruption(std::string last_line);
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  void set_last_line(std::string line);

 private:
  void wait(const std::stop_token& stop);
  [[noreturn]] void end();

  std::mutex mutex_;
  std::string last_line_;
  sigset_t signals_{};
  sigset_t previous_{};
  std::jthread waiting_;
};

}  // namespace beambench::cli
