#include "harness/plugin/program_process.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <string_view>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/base/process_end.hpp"
#include "scenes/base/error.hpp"

namespace beambench::plugin {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kLongestAnswer = 65536;

/// Turns a forked process into the program. Calls only functions that are safe between fork and
/// exec.
[[noreturn]] void become(const char* file, int socket) {
  ::setpgid(0, 0);  // processes that it starts are ended with it
  ::dup2(socket, STDIN_FILENO);
  ::dup2(socket, STDOUT_FILENO);
  ::execl(file, file, "--beambench", "1", nullptr);
  ::_exit(127);
}

}  // namespace

ProgramProcess::ProgramProcess(const std::string& file) : file_(file) {
  const std::string path = std::filesystem::absolute(file).string();
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    fail(fmt::format("cannot be started: {}", std::strerror(errno)));
  }
  process_ = ::fork();
  if (process_ == 0) become(path.c_str(), ends[1]);
  ::close(ends[1]);
  socket_ = ends[0];
  if (process_ < 0) fail(fmt::format("cannot be started: {}", std::strerror(errno)));
  ::setpgid(process_, process_);  // here, too, because either may come first
}

ProgramProcess::~ProgramProcess() { stop(); }

void ProgramProcess::stop() {
  if (socket_ >= 0) ::close(socket_);
  socket_ = -1;
  if (process_ <= 0) return;
  ::kill(-process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
  process_ = -1;
}

void ProgramProcess::fail(const std::string& problem) {
  stop();
  throw PluginError(fmt::format("the program {} {}", file_, problem));
}

void ProgramProcess::refuse_more_lines() {
  fail("wrote more than one line in answer to a request; print other things to stderr");
}

std::string ProgramProcess::request(const std::string& line, double seconds) {
  if (socket_ < 0) fail("has been ended after an error");
  const std::string sent = line + '\n';
  const auto deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                           std::chrono::duration<double>(seconds));
  const auto verb = std::string_view(line).substr(0, line.find(' '));
  std::string answer;
  if (char early = 0; ::recv(socket_, &early, 1, MSG_DONTWAIT) > 0) refuse_more_lines();
  // A request is shorter than a socket's buffer.
  if (::send(socket_, sent.data(), sent.size(), MSG_NOSIGNAL) >= 0) {
    while (answer.find('\n') == std::string::npos) {
      const auto left =
          std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
      pollfd waiting{socket_, POLLIN, 0};
      const int ready = ::poll(&waiting, 1, static_cast<int>(left < 0 ? 0 : left));
      if (ready < 0 && errno == EINTR) continue;
      if (ready == 0) fail(fmt::format("did not answer '{}' within {} s", verb, seconds));
      std::array<char, 4096> part{};
      const ssize_t count = ::recv(socket_, part.data(), part.size(), 0);
      if (count <= 0) break;
      answer.append(part.data(), static_cast<std::size_t>(count));
      if (answer.size() > kLongestAnswer)
        fail(fmt::format("answered '{}' with too long a line", verb));
    }
  }
  const std::size_t end = answer.find('\n');
  if (end == std::string::npos) {
    int status = 0;
    ::kill(-process_, SIGTERM);  // it has closed its output, but may still run
    ::waitpid(process_, &status, 0);
    process_ = -1;
    fail(
        fmt::format("{} instead of answering '{}'; it must be executable, and serve requests "
                    "until its input ends",
                    base::describe_end(status), verb));
  }
  if (end + 1 != answer.size()) {
    refuse_more_lines();
  }
  answer.pop_back();
  return answer;
}

}  // namespace beambench::plugin
