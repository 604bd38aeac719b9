#include "harness/thesis/cluster/watchdog.hpp"

#include <chrono>
#include <csignal>
#include <functional>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace beambench::cluster {
namespace {

using Seconds = std::chrono::duration<double>;

/// How a process ended, and after how long.
struct Ended {
  int status;
  double seconds;
};
/// Runs `program` in a process of its own.
Ended ended(const std::function<void()>& program) {
  const auto begin = std::chrono::steady_clock::now();
  const pid_t child = ::fork();
  if (child == 0) {
    program();
    ::_exit(7);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return {status, Seconds(std::chrono::steady_clock::now() - begin).count()};
}

TEST(Watchdog, KillsAProcessThatIsStoppedWhileItEnds) {
  testing::internal::CaptureStderr();
  const Ended stopped = ended([] {
    const Watchdog watchdog(0.2);
    watchdog.require_end();
    ::raise(SIGSTOP);
  });
  EXPECT_TRUE(WIFSIGNALED(stopped.status));
  EXPECT_EQ(WTERMSIG(stopped.status), SIGKILL);
  EXPECT_GE(stopped.seconds, 0.2);
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "beambench-cluster: a process did not end within 0.2 s and is killed; all requested "
            "files are written\n");
}

TEST(Watchdog, SparesAProcessThatEndsInTime) {
  const Ended in_time = ended([] {
    const Watchdog watchdog(60.0);
    watchdog.require_end();
  });
  EXPECT_TRUE(WIFEXITED(in_time.status));
  EXPECT_EQ(WEXITSTATUS(in_time.status), 7);
}

TEST(Watchdog, SparesAProcessThatMustNotEndYet) {
  const Ended long_running = ended([] {
    const Watchdog watchdog(0.1);
    ::usleep(1'500'000);  // longer than the limit and the grace period
  });
  EXPECT_TRUE(WIFEXITED(long_running.status));
  EXPECT_EQ(WEXITSTATUS(long_running.status), 7);
}

}  // namespace
}  // namespace beambench::cluster
