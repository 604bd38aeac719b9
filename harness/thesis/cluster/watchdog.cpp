#include "harness/thesis/cluster/watchdog.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <string>

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace beambench::cluster {
namespace {

// Milliseconds to wait once more: both processes may have been stopped and then continued.
constexpr int kGrace = 1000;

/// Returns whether the other side is still open; it is closed when its process ends.
bool is_open_after(int socket, int milliseconds) {
  pollfd waited{socket, POLLIN, 0};
  int ready = 0;
  do {
    ready = ::poll(&waited, 1, milliseconds);
  } while (ready < 0 && errno == EINTR);
  return ready == 0;
}

/// Watches the parent from the child. Must not take a lock, because other libraries may have
/// started threads before the fork.
[[noreturn]] void watch(int socket, pid_t parent, int milliseconds, const std::string& message) {
  ::close(STDIN_FILENO);
  ::close(STDOUT_FILENO);
  char byte = 0;
  ssize_t size = 0;
  do {
    size = ::read(socket, &byte, 1);
  } while (size < 0 && errno == EINTR);
  if (size == 1 && is_open_after(socket, milliseconds) && is_open_after(socket, kGrace)) {
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, message.data(), message.size());
    ::kill(parent, SIGKILL);
  }
  ::_exit(0);
}

}  // namespace

Watchdog::Watchdog(double seconds) {
  std::array<int, 2> sockets{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets.data()) != 0) return;
  const std::string message = fmt::format(
      "beambench-cluster: a process did not end within {} s and is killed; all requested files are "
      "written\n",
      seconds);
  const pid_t self = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(sockets[0]);
    watch(sockets[1], self, static_cast<int>(1000.0 * seconds), message);
  }
  ::close(sockets[1]);
  if (child < 0) {
    ::close(sockets[0]);
  } else {
    socket_ = sockets[0];
  }
}

void Watchdog::require_end() const {
  // Does not raise a signal if the child is gone.
  if (socket_ >= 0) ::send(socket_, "", 1, MSG_NOSIGNAL);
}

}  // namespace beambench::cluster
