#include "harness/plugin/activity.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <initializer_list>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/base/messages.hpp"
#include "harness/base/process_end.hpp"

namespace beambench::plugin {
namespace {

using Line = Activity::Line;

constexpr const char* kGuardVariable = "BEAMBENCH_GUARD";  // the descriptor of an Activity

constexpr std::array kPassedOn{SIGINT, SIGTERM, SIGHUP, SIGQUIT};

/// Blocks signals that would end the guard, so that it can forward them to the child.
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

/// Waits until the child has ended, and returns its status.
int watch(pid_t child, const HeldSignals& signals) {
  for (;;) {
    const int signal = signals.wait();
    if (signal != SIGCHLD) {
      ::kill(child, signal);
      continue;
    }
    int status = 0;
    if (::waitpid(child, &status, WNOHANG) == child) return status;  // otherwise it was stopped
  }
}

/// Turns a forked process into the guarded one. Calls only functions that are safe between fork and
/// exec: other threads may have held any lock.
[[noreturn]] void become_guarded(char** arguments, pid_t guard, const HeldSignals& signals) {
  signals.release();
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != guard) ::_exit(base::kMismatch);  // it has ended already
  ::execv("/proc/self/exe", arguments);
  ::_exit(base::kNotRun);
}

pid_t start(char** arguments, const Activity& activity, const HeldSignals& signals) {
  ::setenv(kGuardVariable, std::to_string(activity.descriptor()).c_str(), 1);
  const pid_t guard = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) become_guarded(arguments, guard, signals);
  if (child < 0) {
    throw std::system_error(errno, std::generic_category(), "starting a process for plug-ins");
  }
  return child;
}

/// Returns whether the process was ended by the alarm that is set while a plug-in is loaded.
bool hung(int status) { return WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM; }

/// Returns how the process broke down; nothing if it ended normally.
std::optional<std::string> breakdown(int status, const Activity& activity) {
  if (WIFEXITED(status)) {
    const bool interrupted = WEXITSTATUS(status) == base::kInterrupted;
    if (interrupted || activity.read(Line::kForeign).empty()) return std::nullopt;
  } else if (hung(status)) {
    return "did not come to an end";
  }
  return base::describe_end(status);
}

/// Ends in the same way as the child, for shells and scripts that check this.
int end_by(int signal, const HeldSignals& signals) {
  std::signal(signal, SIG_DFL);
  signals.release();
  ::raise(signal);
  return 128 + signal;
}

int report_breakdown(const Activity& activity, const std::string& what) {
  const std::string foreign = activity.read(Line::kForeign);
  const bool loading = foreign.ends_with(": loading it");
  const std::string_view remedy = loading ? "it was not loaded"
                                          : "none of its results were kept; in a debugger: "
                                            "BEAMBENCH_UNGUARDED=1 gdb --args beambench ...";
  return base::report_error("beambench",
                            foreign.empty()
                                ? fmt::format("a process with plug-ins {}", what)
                                : fmt::format("the plug-in {} {}; {}", foreign, what, remedy),
                            loading ? base::kInvalidInput : base::kMismatch);
}

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

/// Returns new memory. It is all zeros, so its strings are empty.
int new_memory(std::size_t size) {
  const int descriptor = ::memfd_create("beambench", 0);
  if (descriptor < 0 || ::ftruncate(descriptor, static_cast<off_t>(size)) != 0) {
    fail("memory to share with another process");
  }
  return descriptor;
}

/// Concatenates strings, truncated to the size of `place`, with a terminating zero.
void copy(std::span<char> place, std::initializer_list<std::string_view> pieces) {
  std::size_t room = place.size() - 1;
  char* end = place.data();
  for (const std::string_view piece : pieces) {
    const std::size_t length = std::min(piece.size(), room);
    end = std::copy_n(piece.data(), length, end);
    room -= length;
  }
  *end = '\0';
}

}  // namespace

struct Activity::Board {
  std::array<std::array<char, 4096>, 2> lines;  // the maximum length of a path
  std::atomic<std::uint64_t> writes;
};

Activity::Activity() : Activity(new_memory(sizeof(Board))) {}

Activity::Activity(int descriptor) : descriptor_(descriptor) {
  void* shared = ::mmap(nullptr, sizeof(Board), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  if (shared == MAP_FAILED) fail("memory that another process shares");
  board_ = static_cast<Board*>(shared);
}

Activity::~Activity() {
  ::munmap(board_, sizeof(Board));
  ::close(descriptor_);
}

void Activity::write(Line line, std::string_view text, std::string_view rest) {
  copy(board_->lines[static_cast<std::size_t>(line)], {text, rest});
  board_->writes.fetch_add(1, std::memory_order_relaxed);
}

std::uint64_t Activity::count() const { return board_->writes.load(std::memory_order_relaxed); }

std::string Activity::read(Line line) const {
  return board_->lines[static_cast<std::size_t>(line)].data();
}

std::string Activity::variable() const { return fmt::format("{}={}", kGuardVariable, descriptor_); }

int run_guarded(char** arguments) {
  const Activity activity;
  const HeldSignals signals;
  const int status = watch(start(arguments, activity, signals), signals);
  const auto what = breakdown(status, activity);
  if (!what) return WEXITSTATUS(status);
  const bool broke_down = WIFEXITED(status) || hung(status) || base::is_crash(status);
  if (!broke_down) return end_by(WTERMSIG(status), signals);
  return report_breakdown(activity, *what);
}

std::optional<std::string> describe_breakdown(int status, const Activity& activity) {
  const auto what = breakdown(status, activity);
  const std::string foreign = activity.read(Line::kForeign);
  if (what)
    return foreign.empty() ? "it " + *what : fmt::format("the plug-in {} {}", foreign, *what);
  if (WEXITSTATUS(status) == base::kSuccess) return std::nullopt;
  return "it " + base::describe_end(status);
}

std::unique_ptr<Activity> guarded_activity() {
  const char* text = std::getenv(kGuardVariable);
  if (text == nullptr) return nullptr;
  auto activity = std::make_unique<Activity>(std::atoi(text));
  ::unsetenv(kGuardVariable);  // processes started by this one are not guarded
  return activity;
}

}  // namespace beambench::plugin
