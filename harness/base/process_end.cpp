#include "harness/base/process_end.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstring>

#include <fmt/format.h>
#include <sys/wait.h>

namespace beambench::base {

bool is_crash(int status) {
  constexpr std::array kCrashes{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGSYS};
  return WIFSIGNALED(status) && std::ranges::find(kCrashes, WTERMSIG(status)) != kCrashes.end();
}

std::string describe_end(int status) {
  if (WIFEXITED(status)) return fmt::format("ended with exit code {}", WEXITSTATUS(status));
  const int signal = WTERMSIG(status);
  const char* name = ::sigabbrev_np(signal);
  const std::string known = name == nullptr ? std::to_string(signal) : std::string("SIG") + name;
  return is_crash(status) ? fmt::format("crashed ({}: {})", known, ::strsignal(signal))
                          : fmt::format("was ended by {} ({})", known, ::strsignal(signal));
}

}  // namespace beambench::base
