#include "harness/plugin/guard.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/base/exit_code.hpp"
#include "harness/base/messages.hpp"

namespace beambench::plugin {
namespace {

using Line = Activity::Line;

constexpr const char* kVariable = "BEAMBENCH_GUARD";  // the descriptor of an Activity

constexpr std::array kCrashes{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGSYS, SIGALRM};
constexpr std::array kPassedOn{SIGINT, SIGTERM, SIGHUP, SIGQUIT};

/// Keeps the signals that the guard waits for from ending it, and lets the child have them.
class HeldSignals {
 public:
  HeldSignals() {
    ::sigemptyset(&held_);
    ::sigaddset(&held_, SIGCHLD);
    for (const int signal : kPassedOn) ::sigaddset(&held_, signal);
    ::sigprocmask(SIG_BLOCK, &held_, &before_);
  }
  ~HeldSignals() { release(); }
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;

  void release() const { ::sigprocmask(SIG_SETMASK, &before_, nullptr); }
  int wait() const {
    int signal = 0;
    while (::sigwait(&held_, &signal) != 0) {
    }
    return signal;
  }

 private:
  sigset_t held_{};
  sigset_t before_{};
};

/// The child's status when it has ended.
int watch(pid_t child, const HeldSignals& signals) {
  for (;;) {
    const int signal = signals.wait();
    if (signal != SIGCHLD) {
      ::kill(child, signal);
      continue;
    }
    int status = 0;
    if (::waitpid(child, &status, WNOHANG) == child) return status;  // else it was stopped
  }
}

/// Only what is safe between fork and exec: other threads may have held any lock.
[[noreturn]] void become_guarded(char** arguments, pid_t guard, const HeldSignals& signals) {
  signals.release();
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != guard) ::_exit(base::kMismatch);  // it has gone already
  ::execv("/proc/self/exe", arguments);
  ::_exit(base::kNotRun);
}

pid_t start(char** arguments, const Activity& activity, const HeldSignals& signals) {
  ::setenv(kVariable, std::to_string(activity.descriptor()).c_str(), 1);
  const pid_t guard = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) become_guarded(arguments, guard, signals);
  if (child < 0) {
    throw std::system_error(errno, std::generic_category(), "starting a process for plug-ins");
  }
  return child;
}

/// `crashed (SIGSEGV: Segmentation fault)`; nothing where the process ended as it should.
std::optional<std::string> breakdown(int status, const Activity& activity) {
  if (WIFEXITED(status)) {
    const bool interrupted = WEXITSTATUS(status) == base::kInterrupted;
    if (interrupted || activity.read(Line::kForeign).empty()) return std::nullopt;
    return fmt::format("ended the process (exit code {})", WEXITSTATUS(status));
  }
  const int signal = WTERMSIG(status);
  if (signal == SIGALRM) return "did not come to an end";
  return fmt::format("crashed (SIG{}: {})", ::sigabbrev_np(signal), ::strsignal(signal));
}

bool is_crash(int status) {
  return WIFEXITED(status) ||
         std::find(kCrashes.begin(), kCrashes.end(), WTERMSIG(status)) != kCrashes.end();
}

/// Ends as the child did, for shells and scripts that look at it.
int end_by(int signal, const HeldSignals& signals) {
  std::signal(signal, SIG_DFL);
  signals.release();
  ::raise(signal);
  return 128 + signal;
}

int report_breakdown(const Activity& activity, const std::string& what) {
  const std::string foreign = activity.read(Line::kForeign);
  const bool loading = foreign.ends_with(": loading it");
  const std::string_view remedy = loading ? "it was not taken in"
                                          : "nothing of what it answered was kept; in a debugger: "
                                            "BEAMBENCH_UNGUARDED=1 gdb --args beambench ...";
  return base::report_error("beambench",
                            foreign.empty()
                                ? fmt::format("a process with plug-ins {}", what)
                                : fmt::format("the plug-in {} {}; {}", foreign, what, remedy),
                            loading ? base::kInvalidInput : base::kMismatch);
}

}  // namespace

int run_guarded(char** arguments) {
  Activity activity;
  for (;;) {
    const HeldSignals signals;
    const int status = watch(start(arguments, activity, signals), signals);
    const auto what = breakdown(status, activity);
    if (!what) return WEXITSTATUS(status);
    if (!is_crash(status)) return end_by(WTERMSIG(status), signals);
    const std::string foreign = activity.read(Line::kForeign);
    const std::string cell = activity.read(Line::kCell);
    const std::string how =
        foreign.empty() ? "it " + *what : fmt::format("the plug-in {} {}", foreign, *what);
    // A cell is given up once; else there would be no end.
    if (cell.empty() || activity.broken_cells().contains(cell) ||
        !activity.add_broken_cell(cell, how)) {
      return report_breakdown(activity, *what);
    }
    activity.clear(Line::kCell);
    activity.clear(Line::kForeign);
  }
}

std::unique_ptr<Activity> guarded_activity() {
  const char* text = std::getenv(kVariable);
  if (text == nullptr) return nullptr;
  auto activity = std::make_unique<Activity>(std::atoi(text));
  ::unsetenv(kVariable);  // what this process starts is not guarded
  return activity;
}

}  // namespace beambench::plugin
