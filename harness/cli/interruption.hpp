#pragma once
// Handles SIGINT and SIGTERM in commands that measure.

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "harness/base/messages.hpp"

namespace beambench::cli {

/// During its lifetime, SIGINT and SIGTERM end the process immediately with exit code 130 and a
/// last line on stderr. For work whose results survive being killed at any moment.
///
/// The signals are blocked, and a separate thread receives them, because it is not restricted like
/// a signal handler. Construct this object before starting other threads, so that they inherit the
/// blocked signals.
class Interruption {
 public:
  explicit Interruption(std::string last_line) : last_line_(std::move(last_line)) {
    ::sigemptyset(&signals_);
    ::sigaddset(&signals_, SIGINT);
    ::sigaddset(&signals_, SIGTERM);
    ::pthread_sigmask(SIG_BLOCK, &signals_, &previous_);
    waiting_ = std::jthread([this](const std::stop_token& stop) {
      int signal = 0;
      while (::sigwait(&signals_, &signal) != 0) {
      }
      if (!stop.stop_requested()) end();
    });
  }
  ~Interruption() {
    waiting_.request_stop();
    ::pthread_kill(waiting_.native_handle(), SIGTERM);  // only to this thread
    waiting_.join();
    ::pthread_sigmask(SIG_SETMASK, &previous_, nullptr);
  }
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  void set_last_line(std::string line) {
    const std::lock_guard lock(mutex_);
    last_line_ = std::move(line);
  }
  /// Sets a folder to be removed when the process ends, because nothing in it is worth keeping.
  void set_folder_to_remove(std::filesystem::path folder) {
    const std::lock_guard lock(mutex_);
    folder_to_remove_ = std::move(folder);
  }

 private:
  [[noreturn]] void end() {
    const std::lock_guard lock(mutex_);
    ::flockfile(stderr);  // never released: nothing follows the last line
    const char* wipe = ::isatty(STDERR_FILENO) == 1 ? "\r\033[K" : "";
    base::print_message(stderr, fmt::format("{}{}\n", wipe, last_line_));
    std::error_code ignored;
    if (!folder_to_remove_.empty()) std::filesystem::remove_all(folder_to_remove_, ignored);
    std::_Exit(base::kInterrupted);
  }

  std::mutex mutex_;
  std::string last_line_;
  std::filesystem::path folder_to_remove_;
  sigset_t signals_{};
  sigset_t previous_{};
  std::jthread waiting_;
};

}  // namespace beambench::cli
