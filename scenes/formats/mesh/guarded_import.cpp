
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "scenes/core/error.hpp"
#include "scenes/formats/mesh/mesh.hpp"
#include "scenes/formats/mesh/mesh_import.hpp"

namespace beambench::scenes::mesh {
namespace {

// The first byte of what the child sends.
constexpr char kMesh = 'm';
constexpr char kRefusal = 'r';

[[noreturn]] void refuse_by_errno(const std::filesystem::path& path, std::string_view what) {
  throw InputError(fmt::format("{}: {} failed ({}); close other programs and try again",
                               path.string(), what, std::strerror(errno)));
}

rlim_t seconds_allowed(std::string_view bytes) { return 2 + bytes.size() / (1U << 20U); }

/// The two ends of a pipe, closed at destruction.
class Pipe {
 public:
  explicit Pipe(const std::filesystem::path& path) {
    if (::pipe2(ends_.data(), O_CLOEXEC) != 0) refuse_by_errno(path, "making a pipe");
  }
  ~Pipe() {
    for (const int end : ends_) ::close(end);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  void close_writing_end() {
    ::close(ends_[1]);
    ends_[1] = -1;
  }

  void write(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t count = ::write(ends_[1], bytes.data(), bytes.size());
      if (count < 0 && errno != EINTR) return;  // the reader is gone
      if (count > 0) bytes.remove_prefix(static_cast<std::size_t>(count));
    }
  }

  /// All that comes until the other side has closed its end.
  std::string read() const {
    std::string bytes;
    std::array<char, 1U << 16U> block{};
    for (;;) {
      const ssize_t count = ::read(ends_[0], block.data(), block.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return bytes;
      bytes.append(block.data(), static_cast<std::size_t>(count));
    }
  }

 private:
  std::array<int, 2> ends_{-1, -1};
};

/// What the child does: it sends the mesh, or why there is none, and ends.
[[noreturn]] void import_and_send(const Pipe& pipe, pid_t parent, std::string_view bytes,
                                  const std::string& ending, const std::filesystem::path& path) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);  // it has gone already
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  const rlimit time{seconds_allowed(bytes), seconds_allowed(bytes) + 1};
  ::setrlimit(RLIMIT_CPU, &time);
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  // Assimp's last messages are for Assimp's developers, and what is in a buffer of stdout is the
  // parent's to write.
  ::dup2(nowhere, STDERR_FILENO);
  ::dup2(nowhere, STDOUT_FILENO);
  std::string reply;
  try {
    reply = kMesh + encode(import_mesh(bytes, ending, path));
  } catch (const std::exception& error) {  // an InputError, or out of memory
    reply = kRefusal + std::string(error.what());
  }
  pipe.write(reply);
  ::_exit(0);
}

/// Waits for the child, even when reading fails; its status.
class Child {
 public:
  explicit Child(pid_t id) : id_(id) {}
  ~Child() { wait(); }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  int wait() {
    while (id_ > 0 && ::waitpid(id_, &status_, 0) < 0 && errno == EINTR) {
    }
    id_ = 0;
    return status_;
  }

 private:
  pid_t id_;
  int status_ = 0;
};

[[noreturn]] void refuse_no_reply(int status, std::string_view bytes,
                                  const std::filesystem::path& path) {
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  const std::string end =
      signal == SIGXCPU || signal == SIGKILL
          ? fmt::format("needed more than {} s or all of the memory", seconds_allowed(bytes))
          : std::string("crashed");
  throw InputError(
      fmt::format("{}: it cannot be read as a mesh (Assimp {}): most likely it is malformed or cut "
                  "off; export it again, or convert it to another format",
                  path.string(), end));
}

}  // namespace

ImportedMesh guarded_import(std::string_view bytes, const std::string& ending,
                            const std::filesystem::path& path) {
  Pipe pipe(path);
  const pid_t parent = ::getpid();
  const pid_t id = ::fork();
  if (id < 0) refuse_by_errno(path, "starting a process");
  if (id == 0) import_and_send(pipe, parent, bytes, ending, path);

  Child child(id);
  pipe.close_writing_end();
  const std::string reply = pipe.read();
  const int status = child.wait();
  if (reply.empty() || !WIFEXITED(status)) refuse_no_reply(status, bytes, path);
  const std::string_view rest = std::string_view(reply).substr(1);
  if (reply.front() == kRefusal) throw InputError(std::string(rest));
  return decode(rest);
}

}  // namespace beambench::scenes::mesh
