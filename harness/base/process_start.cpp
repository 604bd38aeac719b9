#include "harness/base/process_start.hpp"

#include <array>
#include <cerrno>
#include <csignal>

#include <fcntl.h>
#include <unistd.h>

namespace beambench::base {

void prepare_process() {
  struct Stream {
    int descriptor;
    int mode;
  };
  constexpr std::array<Stream, 3> kStreams{
      {{STDIN_FILENO, O_RDONLY}, {STDOUT_FILENO, O_RDONLY}, {STDERR_FILENO, O_WRONLY}}};
  for (const Stream& stream : kStreams) {
    if (::fcntl(stream.descriptor, F_GETFD) == 0 || errno != EBADF) continue;
    // open returns the lowest free descriptor, which is this one: all lower ones are open.
    static_cast<void>(::open("/dev/null", stream.mode));
  }
  std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace beambench::base
