#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <new>
#include <stdexcept>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "scenes/base/error.hpp"
#include "scenes/base/process_memory.hpp"
#include "scenes/formats/mesh/mesh.hpp"
#include "scenes/formats/mesh/mesh_import.hpp"

namespace beambench::scenes::mesh {
namespace {

// The first byte that the child sends.
constexpr char kMesh = 'm';
constexpr char kRefusal = 'r';

[[noreturn]] void refuse_by_errno(const std::filesystem::path& path, std::string_view what) {
  throw InputError(fmt::format("{}: {} failed ({}); close other programs and try again",
                               path.string(), what, std::strerror(errno)));
}

constexpr double kGibi = 0x1p30;

std::string out_of_memory(const std::filesystem::path& path, const ImportLimits& limits) {
  return fmt::format(
      "{}: there is not enough memory to read it ({:.2g} GiB were left to it); close other "
      "programs, or reduce its triangles",
      path.string(), static_cast<double>(limits.memory) / kGibi);
}

/// The mesh did not arrive in time.
struct TooLate {};

/// A process that claims to send a larger mesh than this is faulty.
constexpr std::uint64_t kLargestReply = std::uint64_t{1} << 37U;

/// The two ends of a pipe, closed at destruction.
class Pipe {
 public:
  using Clock = std::chrono::steady_clock;

  /// Reading throws TooLate if nothing arrives before the deadline.
  Pipe(const std::filesystem::path& path, Clock::time_point deadline) : deadline_(deadline) {
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

  /// Fills a buffer; throws std::out_of_range if the other side closes its end early.
  void read(char* buffer, std::size_t size) const {
    while (size > 0) {
      const std::size_t count = read_some(buffer, size);
      if (count == 0) throw std::out_of_range("the reply ends too early");
      buffer += count;
      size -= count;
    }
  }

  /// Returns everything that arrives until the other side closes its end.
  std::string read_rest() const {
    std::string text;
    std::array<char, 4096> block{};
    while (const std::size_t count = read_some(block.data(), block.size())) {
      text.append(block.data(), count);
    }
    return text;
  }

 private:
  /// Waits for bytes and returns how many arrived; 0 at the end.
  std::size_t read_some(char* buffer, std::size_t size) const {
    for (;;) {
      wait_for_bytes();
      const ssize_t count = ::read(ends_[0], buffer, size);
      if (count >= 0) return static_cast<std::size_t>(count);
      if (errno != EINTR) return 0;
    }
  }

  void wait_for_bytes() const {
    for (;;) {
      const auto left =
          std::chrono::ceil<std::chrono::milliseconds>(deadline_ - Clock::now()).count();
      if (left <= 0) throw TooLate();
      constexpr std::int64_t kLongestWait = 1'000'000;  // the timeout is an int
      pollfd end{ends_[0], POLLIN, 0};
      const int ready =
          ::poll(&end, 1, static_cast<int>(std::min<std::int64_t>(left, kLongestWait)));
      if (ready > 0 || (ready < 0 && errno != EINTR)) return;
    }
  }

  void close_end(std::size_t end) {
    if (ends_[end] >= 0) ::close(ends_[end]);
    ends_[end] = -1;
  }

  std::array<int, 2> ends_{-1, -1};
  Clock::time_point deadline_;
};

/// Limits this process. Memory that is already mapped (inherited from the parent) does not count.
void keep_within(const ImportLimits& limits) {
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  const auto seconds = static_cast<rlim_t>(limits.processor.count());
  const rlimit time{seconds, seconds + 1};
  ::setrlimit(RLIMIT_CPU, &time);
  // Limits the data, not the address space, because sanitizers reserve terabytes of the latter.
  // Such reservations also count as data, but exist before the limit is set.
  if (const auto used = mapped_data_bytes()) {
    const rlimit memory{*used + limits.memory, RLIM_INFINITY};
    ::setrlimit(RLIMIT_DATA, &memory);
  }
}

/// Runs in the child: sends the mesh or the reason for its absence, and exits.
[[noreturn]] void import_and_send(const Pipe& pipe, pid_t parent, std::string_view bytes,
                                  const std::string& ending, const std::filesystem::path& path,
                                  const ImportLimits& limits) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);  // the parent has already exited
  keep_within(limits);
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  // A library's last messages are only of use to its developers; the contents of stdout's buffer
  // are written by the parent.
  ::dup2(nowhere, STDERR_FILENO);
  ::dup2(nowhere, STDOUT_FILENO);
  try {
    const ImportedMesh mesh = import_mesh(bytes, ending, path);
    pipe.write({&kMesh, 1});
    encode(mesh, [&](const char* part, std::size_t count) { pipe.write({part, count}); });
  } catch (const InputError& error) {
    pipe.write(kRefusal + std::string(error.what()));
  } catch (const std::bad_alloc&) {
    pipe.write(kRefusal + out_of_memory(path, limits));
  } catch (const std::exception& error) {
    pipe.write(kRefusal + fmt::format("{}: it cannot be read as a mesh ({}); export it again",
                                      path.string(), error.what()));
  }
  ::_exit(0);
}

/// A process that is waited for, and killed when its reply is no longer wanted.
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

[[noreturn]] void refuse_no_reply(const std::string& ending, const std::filesystem::path& path,
                                  std::string_view end) {
  throw InputError(
      fmt::format("{}: it cannot be read as a mesh (its importer, {}, {}): most likely it is "
                  "malformed or cut off; export it again, or convert it to another format",
                  path.string(), importer_of(ending), end));
}

/// Describes how a child that sent no mesh ended.
std::string end_of(int status, const ImportLimits& limits) {
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (signal != SIGXCPU && signal != SIGKILL) return "crashed";
  return fmt::format("needed more than {} s or all of the memory", limits.processor.count());
}

/// Receives the mesh from the child. Throws InputError with the child's reason if it sent none, and
/// std::out_of_range if the child ended early.
ImportedMesh receive(const Pipe& pipe) {
  char kind = 0;
  pipe.read(&kind, 1);
  if (kind == kRefusal) throw InputError(pipe.read_rest());
  return decode([&](char* buffer, std::size_t count) { pipe.read(buffer, count); }, kLargestReply);
}

}  // namespace

ImportLimits import_limits(std::string_view bytes, std::string_view ending) {
  const bool is_gltf = ending == "glb" || ending == "gltf";
  const std::chrono::seconds processor((is_gltf ? 120 : 2) + bytes.size() / (1U << 20U));
  const std::uint64_t memory = (std::uint64_t{is_gltf ? 32U : 4U} << 30U) + 64 * bytes.size();
  return {processor, 10 * processor + std::chrono::seconds(30),
          std::min(memory, available_memory().value_or(memory))};
}

ImportedMesh guarded_import(std::string_view bytes, const std::string& ending,
                            const std::filesystem::path& path, const ImportLimits& limits) {
  Pipe pipe(path, Pipe::Clock::now() + limits.elapsed);
  const pid_t parent = ::getpid();
  const pid_t id = ::fork();
  if (id < 0) refuse_by_errno(path, "starting a process");
  if (id == 0) import_and_send(pipe, parent, bytes, ending, path, limits);

  Child child(id);
  pipe.close_writing_end();
  try {
    return receive(pipe);
  } catch (const std::bad_alloc&) {
    throw InputError(out_of_memory(path, limits));
  } catch (const std::out_of_range&) {
    pipe.close_reading_end();  // otherwise the child might block while sending
    refuse_no_reply(ending, path, end_of(child.wait(), limits));
  } catch (const TooLate&) {  // leaving kills the child
    refuse_no_reply(ending, path,
                    fmt::format("took more than {} s by the clock",
                                std::chrono::duration<double>(limits.elapsed).count()));
  }
}

}  // namespace beambench::scenes::mesh
