#include "harness/base/progress.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "harness/base/messages.hpp"
#include "scenes/base/printable.hpp"

namespace beambench::base {
namespace {

constexpr std::chrono::milliseconds kRedrawInterval{200};
constexpr double kEarlyPart = 0.005;  // below this share of the work, an estimate is only a guess
constexpr const char* kWipe = "\r\033[K";

/// Returns the number of columns of the terminal; 80 if unknown.
std::size_t columns_of(std::FILE* stream) {
  winsize size{};
  const bool known = ::ioctl(::fileno(stream), TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

}  // namespace

std::string format_duration(double seconds) {
  if (seconds < 10.0) return fmt::format("{:.1f} s", seconds);
  const long long whole = std::llround(seconds);
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

double remaining_seconds(double elapsed, double part) { return elapsed * (1.0 - part) / part; }

Progress::Progress(std::size_t cells, std::FILE* stream)
    : Progress(cells, stream, ::isatty(::fileno(stream)) == 1) {}

Progress::Progress(std::size_t cells, std::FILE* stream, bool terminal)
    : stream_(stream),
      terminal_(terminal),
      cells_(std::max<std::size_t>(cells, 1)),
      begin_(Clock::now()),
      last_draw_(begin_ - kRedrawInterval) {}

Progress::~Progress() { clear(); }

void Progress::start(std::string_view name) {
  name_ = printable(name);
  if (terminal_) draw(0.0);
}

void Progress::advance(double part) {
  if (terminal_ && Clock::now() - last_draw_ >= kRedrawInterval) draw(part);
}

void Progress::finish(std::string_view result) {
  ++done_;
  if (terminal_) {
    draw(0.0);
  } else {
    print_message(stream_, fmt::format("[{}/{}] {}: {}\n", done_, cells_, name_, result));
  }
}

void Progress::skip(std::size_t cells) {
  cells_ = std::max<std::size_t>(cells_ - std::min(cells, cells_), 1);
}

void Progress::say(std::string_view line) {
  clear();
  print_message(stream_, fmt::format("{}\n", line));
}

void Progress::draw(double part) {
  last_draw_ = Clock::now();
  const double elapsed = std::chrono::duration<double>(last_draw_ - begin_).count();
  const double done =
      std::min((static_cast<double>(done_) + part) / static_cast<double>(cells_), 1.0);
  const std::string remaining =
      done < kEarlyPart ? std::string("estimating")
                        : fmt::format("{} left", format_duration(remaining_seconds(elapsed, done)));
  std::string line = fmt::format("{:3.0f}%  {}/{}  {}  {}", std::floor(100.0 * done),
                                 std::min(done_ + 1, cells_), cells_, remaining, name_);
  // A line wider than the terminal could not be erased.
  line.resize(std::min(line.size(), columns_of(stream_) - 1));
  print_message(stream_, kWipe + line);
  drawn_ = true;
}

void Progress::clear() {
  if (!drawn_) return;
  print_message(stream_, kWipe);
  drawn_ = false;
}

}  // namespace beambench::base
