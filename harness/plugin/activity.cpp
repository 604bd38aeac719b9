#include "harness/plugin/activity.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <initializer_list>
#include <span>
#include <sstream>
#include <system_error>

#include <sys/mman.h>
#include <unistd.h>

namespace beambench::plugin {

struct Activity::Board {
  std::array<std::array<char, 4096>, 3> lines;           // a path is no longer
  std::array<char, std::size_t{1} << 17U> broken_cells;  // key, tab, sentence, line end
};

namespace {

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

/// New memory is all zeros: empty texts.
int new_memory(std::size_t size) {
  const int descriptor = ::memfd_create("beambench", 0);
  if (descriptor < 0 || ::ftruncate(descriptor, static_cast<off_t>(size)) != 0) {
    fail("memory to share with another process");
  }
  return descriptor;
}

/// Concatenates texts, truncated to `place`, and ends with a zero.
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
}

std::string Activity::read(Line line) const {
  return board_->lines[static_cast<std::size_t>(line)].data();
}

bool Activity::add_broken_cell(std::string_view key, std::string_view how) {
  const std::span<char> all = board_->broken_cells;
  const std::size_t used = std::strlen(all.data());
  if (used + key.size() + how.size() + 3 > all.size()) return false;
  std::string sentence(how);
  std::ranges::replace(sentence, '\n', ' ');
  copy(all.subspan(used), {key, "\t", sentence, "\n"});
  return true;
}

std::map<std::string, std::string> Activity::broken_cells() const {
  std::map<std::string, std::string> cells;
  std::istringstream text(board_->broken_cells.data());
  for (std::string line; std::getline(text, line);) {
    const std::size_t tab = line.find('\t');
    cells[line.substr(0, tab)] = line.substr(tab + 1);
  }
  return cells;
}

}  // namespace beambench::plugin
