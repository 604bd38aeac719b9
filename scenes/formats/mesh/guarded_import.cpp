#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <new>
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

std::string out_of_memory(const std::filesystem::path& path) {
  return fmt::format(
      "{}: there is not enough memory to read it; close other programs, or reduce its triangles",
      path.string());
}

rlim_t seconds_allowed(std::string_view bytes, std::string_view ending) {
  const rlim_t least = ending == "glb" || ending == "gltf" ? 120 : 2;
  return least + bytes.size() / (1U << 20U);
}

/// A mesh that claims to be larger than this was sent by a process that had gone wrong.
constexpr std::uint64_t kLargestReply = std::uint64_t{1} << 37U;

/// The two ends of a pipe, closed at destruction.
class Pipe {
 public:
  explicit Pipe(const std::filesystem::path& path) {
    if (::pipe2(ends_.data(), O_CLOEXEC) != 0) refuse_by_errno(path, "making a pipe");
  }
  ~Pipe() {
    close_reading_end();
    close_writing_end();
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  void close_reading_end() { close_end(0); }
  void close_writing_end() { close_end(1); }

  void write(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t count = ::write(ends_[1], bytes.data(), bytes.size());
      if (count < 0 && errno != EINTR) return;  // the reader is gone
      if (count > 0) bytes.remove_prefix(static_cast<std::size_t>(count));
    }
  }

  /// Fills a buffer; throws std::out_of_range when the other side closes its end before.
  void read(char* buffer, std::size_t size) const {
    while (size > 0) {
      const ssize_t count = ::read(ends_[0], buffer, size);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) throw std::out_of_range("the reply ends too early");
      buffer += count;
      size -= static_cast<std::size_t>(count);
    }
  }

  /// All that comes until the other side has closed its end.
  std::string read_rest() const {
    std::string text;
    std::array<char, 4096> block{};
    for (;;) {
      const ssize_t count = ::read(ends_[0], block.data(), block.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return text;
      text.append(block.data(), static_cast<std::size_t>(count));
    }
  }

 private:
  void close_end(std::size_t end) {
    if (ends_[end] >= 0) ::close(ends_[end]);
    ends_[end] = -1;
  }

  std::array<int, 2> ends_{-1, -1};
};

/// What the child does: it sends the mesh, or why there is none, and ends.
[[noreturn]] void import_and_send(const Pipe& pipe, pid_t parent, std::string_view bytes,
                                  const std::string& ending, const std::filesystem::path& path) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);  // it has gone already
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  const rlim_t seconds = seconds_allowed(bytes, ending);
  const rlimit time{seconds, seconds + 1};
  ::setrlimit(RLIMIT_CPU, &time);
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  // A library's last messages are for its developers, and what is in a buffer of stdout is the
  // parent's to write.
  ::dup2(nowhere, STDERR_FILENO);
  ::dup2(nowhere, STDOUT_FILENO);
  try {
    const ImportedMesh mesh = import_mesh(bytes, ending, path);
    pipe.write({&kMesh, 1});
    encode(mesh, [&](const char* part, std::size_t count) { pipe.write({part, count}); });
  } catch (const InputError& error) {
    pipe.write(kRefusal + std::string(error.what()));
  } catch (const std::bad_alloc&) {
    pipe.write(kRefusal + out_of_memory(path));
  } catch (const std::exception& error) {
    pipe.write(kRefusal + fmt::format("{}: it cannot be read as a mesh ({}); export it again",
                                      path.string(), error.what()));
  }
  ::_exit(0);
}

/// A process that is waited for, and ended when its reply is no longer wanted.
class Child {
 public:
  explicit Child(pid_t id) : id_(id) {}
  ~Child() {
    if (id_ > 0) ::kill(id_, SIGKILL);
    wait();
  }
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

[[noreturn]] void refuse_no_reply(int status, std::string_view bytes, const std::string& ending,
                                  const std::filesystem::path& path) {
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  const std::string end = signal == SIGXCPU || signal == SIGKILL
                              ? fmt::format("needed more than {} s or all of the memory",
                                            seconds_allowed(bytes, ending))
                              : std::string("crashed");
  throw InputError(
      fmt::format("{}: it cannot be read as a mesh (its importer, {}, {}): most likely it is "
                  "malformed or cut off; export it again, or convert it to another format",
                  path.string(), importer_of(ending), end));
}

/// What the child sent: a mesh. Throws InputError with the child's reason when that is none, and
/// std::out_of_range when the child ended before.
ImportedMesh receive(const Pipe& pipe) {
  char kind = 0;
  pipe.read(&kind, 1);
  if (kind == kRefusal) throw InputError(pipe.read_rest());
  return decode([&](char* buffer, std::size_t count) { pipe.read(buffer, count); }, kLargestReply);
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
  try {
    return receive(pipe);
  } catch (const std::bad_alloc&) {
    throw InputError(out_of_memory(path));
  } catch (const std::out_of_range&) {
    pipe.close_reading_end();  // what more the child might send would keep it waiting
    refuse_no_reply(child.wait(), bytes, ending, path);
  }
}

}  // namespace beambench::scenes::mesh
