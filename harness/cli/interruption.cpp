#include "harness/cli/interruption.hpp"

#include <cstdio>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "harness/base/exit_code.hpp"

namespace beambench::cli {
Interruption::Interruption(std::string last_line) : last_line_(std::move(last_line)) {
  ::sigemptyset(&signals_);
  ::sigaddset(&signals_, SIGINT);
  ::sigaddset(&signals_, SIGTERM);
  ::pthread_sigmask(SIG_BLOCK, &signals_, &previous_);
  waiting_ = std::jthread([this](const std::stop_token& stop) { wait(stop); });
}

Interruption::~Interruption() {
  waiting_.request_stop();
  ::pthread_kill(waiting_.native_handle(), SIGTERM);  // to that thread alone
  waiting_.join();
  ::pthread_sigmask(SIG_SETMASK, &previous_, nullptr);
}

void Interruption::set_last_line(std::string line) {
  const std::lock_guard lock(mutex_);
  last_line_ = std::move(line);
}

void Interruption::wait(const std::stop_token& stop) {
  int signal = 0;
  while (::sigwait(&signals_, &signal) != 0) {
  }
  if (!stop.stop_requested()) end();
}

void Interruption::end() {
  const std::lock_guard lock(mutex_);
  ::flockfile(stderr);  // for good: nobody writes behind the last line
  const char* wipe = ::isatty(STDERR_FILENO) == 1 ? "\r\033[K" : "";
  fmt::print(stderr, "{}{}\n", wipe, last_line_);
  std::fflush(stderr);
  std::_Exit(base::kInterrupted);
}

}  // namespace beambench::cli
