#include "harness/plugin/isolated.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "accel/core/support.hpp"
#include "harness/base/stopwatch.hpp"
#include "harness/plugin/load_plugin.hpp"
#include "scenes/base/error.hpp"

namespace beambench::plugin {
namespace {

/// The first character of an outcome that a child writes.
enum Kind : char { kResult = 'R', kInputError = 'I', kUnsupported = 'U', kOtherError = 'E' };

/// Calls the work, and returns its outcome as a string.
std::string outcome_of(const std::function<std::string()>& work) {
  try {
    return static_cast<char>(kResult) + work();
  } catch (const accel::UnsupportedError& error) {
    return static_cast<char>(kUnsupported) + std::string(error.what());
  } catch (const InputError& error) {
    return static_cast<char>(kInputError) + std::string(error.what());
  } catch (const std::exception& error) {
    return static_cast<char>(kOtherError) + std::string(error.what());
  }
}

[[noreturn]] void serve(const std::function<std::string()>& work, pid_t parent, int output) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);  // it has ended already
  const std::string outcome = outcome_of(work);
  std::string_view rest = outcome;
  while (!rest.empty()) {
    const ssize_t count = ::write(output, rest.data(), rest.size());
    if (count < 0 && errno != EINTR) ::_exit(1);
    if (count > 0) rest.remove_prefix(static_cast<std::size_t>(count));
  }
  std::fflush(nullptr);  // output of the plug-in
  ::_exit(0);
}

[[noreturn]] void rethrow(Kind kind, const std::string& message) {
  if (kind == kUnsupported) throw accel::UnsupportedError(message);
  if (kind == kInputError) throw InputError(message);
  throw PluginError(message);
}

/// A child process and the pipe on which it writes its outcome.
class Child {
 public:
  explicit Child(const std::function<std::string()>& work) {
    std::array<int, 2> ends{};
    std::fflush(nullptr);  // otherwise the child would print it again
    const pid_t parent = ::getpid();
    if (::pipe2(ends.data(), O_CLOEXEC) != 0 || (id_ = ::fork()) < 0) {
      throw InputError(
          fmt::format("cannot start a process for a plug-in: {}", std::strerror(errno)));
    }
    if (id_ == 0) serve(work, parent, ends[1]);
    ::close(ends[1]);
    output_ = ends[0];
  }
  ~Child() {
    if (id_ > 0) end();
    ::close(output_);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Reads the child's output until the child closes its pipe. Returns false if one action of the
  /// plug-in took longer than `seconds`.
  bool read(std::string& outcome, double seconds, const Activity& activity) const {
    constexpr int kMillisecondsBetweenLooks = 100;
    std::uint64_t actions = activity.count();
    base::Stopwatch since;
    for (;;) {
      pollfd waiting{output_, POLLIN, 0};
      if (::poll(&waiting, 1, kMillisecondsBetweenLooks) > 0) {
        std::array<char, 1U << 16U> buffer;
        const ssize_t count = ::read(output_, buffer.data(), buffer.size());
        if (count == 0) return true;
        if (count > 0) outcome.append(buffer.data(), static_cast<std::size_t>(count));
      }
      const bool is_new = std::exchange(actions, activity.count()) != actions;
      if (is_new || activity.read(Activity::Line::kForeign).empty()) since = {};
      if (since.seconds() > seconds) return false;
    }
  }

  /// Ends the child if it is still running.
  void end() {
    ::kill(id_, SIGKILL);
    wait();
  }
  /// Waits until the child has ended. Returns its status.
  int wait() {
    int status = 0;
    while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    id_ = -1;
    return status;
  }

 private:
  pid_t id_ = -1;
  int output_ = -1;
};

}  // namespace

bool must_isolate() {
  return std::getenv("BEAMBENCH_UNGUARDED") == nullptr &&
         std::ranges::any_of(loaded_plugins(), &LoadedPlugin::is_shared_object);
}

std::string run_isolated(const std::function<std::string()>& work, double seconds) {
  if (!must_isolate()) return work();
  Activity& activity = activity_of_plugins();
  Child child(work);
  std::string outcome;
  if (!child.read(outcome, seconds, activity)) {
    const std::string action = activity.read(Activity::Line::kForeign);
    child.end();
    activity.clear(Activity::Line::kForeign);
    throw PluginError(fmt::format(
        "the plug-in {} did not end within {} s; --timeout sets this limit", action, seconds));
  }
  const int status = child.wait();
  const auto breakdown = describe_breakdown(status, activity);
  activity.clear(Activity::Line::kForeign);
  if (outcome.empty()) {
    throw PluginError(breakdown.value_or("a process with plug-ins ended without a result"));
  }
  if (outcome.front() != kResult) rethrow(static_cast<Kind>(outcome.front()), outcome.substr(1));
  return outcome.substr(1);
}

}  // namespace beambench::plugin
