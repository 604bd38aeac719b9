#include "scenes/base/files.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <new>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <streambuf>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "scenes/base/error.hpp"
#include "scenes/base/plain_text.hpp"

namespace beambench {
namespace {

namespace fs = std::filesystem;

/// An open file, closed by the destructor. The descriptor is -1 if opening failed, with errno set.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const { return number_; }

 private:
  int number_;
};

// Input

constexpr std::size_t kFirstBlock = std::size_t{1} << 16U;   // read first if the length is unknown
constexpr std::size_t kLargestRead = std::size_t{1} << 30U;  // one call reads no more than 2 GiB
constexpr std::size_t kStreamBlock = std::size_t{1} << 18U;
constexpr std::size_t kLongestLine = std::size_t{1} << 28U;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

[[noreturn]] void refuse_input(const std::string& name, std::string_view why,
                               std::string_view remedy) {
  throw InputError(fmt::format("{}: cannot be read: {}; {}", name, why, remedy));
}

[[noreturn]] void refuse_input_error(const std::string& name, int error) {
  const bool path_is_wrong = error == ENOENT || error == EACCES || error == ENOTDIR;
  refuse_input(name, std::strerror(error),
               path_is_wrong ? "check the path and its permissions" : "try a copy on another disk");
}

[[noreturn]] void refuse_size(const std::string& name, std::uint64_t max_bytes) {
  refuse_input(name, fmt::format("it holds more than {} bytes", max_bytes),
               "divide it or reduce it");
}

[[noreturn]] void refuse_short_input(const std::string& name, std::uint64_t bytes,
                                     std::uint64_t length) {
  refuse_input(name, fmt::format("it ended after {} of its {} bytes", bytes, length),
               "wait until it is no longer being written");
}

[[noreturn]] void refuse_empty_pipe(const std::string& name) {
  refuse_input(name, "it is a pipe into which nothing is written",
               "start the program that writes into it first");
}

/// A path opened for reading. With O_NONBLOCK, opening a named pipe does not wait for a writer; if
/// there is a writer, reads may wait for it.
struct OpenInput {
  explicit OpenInput(const fs::path& path)
      : descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
    struct stat status {};
    if (descriptor.number() < 0 || ::fstat(descriptor.number(), &status) != 0 ||
        ::fcntl(descriptor.number(), F_SETFL, 0) != 0) {
      refuse_input_error(path.string(), errno);
    }
    is_pipe = S_ISFIFO(status.st_mode);
  }

  Descriptor descriptor;
  bool is_pipe = false;
};

/// Returns how many bytes of a regular file remain, or 0 for anything without a length (a pipe, a
/// file in /proc).
std::uint64_t known_length(int descriptor, const std::string& name) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) refuse_input_error(name, errno);
  if (S_ISDIR(status.st_mode)) refuse_input(name, "it is a folder", "name a file in it");
  if (!S_ISREG(status.st_mode)) return 0;
  const off_t position = ::lseek(descriptor, 0, SEEK_CUR);
  return static_cast<std::uint64_t>(
      std::max<off_t>(status.st_size - std::max<off_t>(position, 0), 0));
}

/// Returns whether the input is a device, such as /dev/zero, from which nobody intends to read
/// gigabytes.
bool is_device(int descriptor) {
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 && S_ISCHR(status.st_mode);
}

std::string read_whole(int descriptor, const std::string& name, std::uint64_t max_bytes) {
  const std::uint64_t length = known_length(descriptor, name);
  if (is_device(descriptor)) max_bytes = std::min(max_bytes, kLargestDocument);
  if (length > max_bytes) refuse_size(name, max_bytes);
  // One byte more than the known length, so that the end is detected without growing the buffer.
  std::string bytes(length > 0 ? length + 1 : kFirstBlock, '\0');
  std::size_t used = 0;
  for (;;) {
    if (used == bytes.size()) bytes.resize(2 * bytes.size());
    const ssize_t count =
        ::read(descriptor, bytes.data() + used, std::min(bytes.size() - used, kLargestRead));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) refuse_input_error(name, errno);
    if (count == 0) break;
    used += static_cast<std::size_t>(count);
    if (used > max_bytes) refuse_size(name, max_bytes);
  }
  if (used < length) refuse_short_input(name, used, length);
  bytes.resize(used);
  return bytes;
}

// Output

constexpr const char* kPartial = ".partial";  // part of the name of a file being written

/// The kind of target that an output path refers to.
struct OutputTarget {
  enum class Kind {
    kFile,    ///< an existing or new regular file: replaced by renaming a temporary file
    kFolder,  ///< cannot be written
    kNode,    ///< a device, a pipe or a socket: written to, never replaced
    kOpen     ///< the destination of standard output or error: appended to
  };
  Kind kind;
  fs::path path;        ///< with symbolic links resolved; for a kNode, as given
  int descriptor = -1;  ///< set for a kOpen
};

constexpr int kMaxLinks = 40;  // the kernel's own limit

[[noreturn]] void fail(const fs::path& path, int error) {
  throw fs::filesystem_error("cannot be written", path, {error, std::generic_category()});
}

bool is_same(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

/// Returns the descriptor of standard output or error, whichever goes to the file, or -1 if neither
/// does. If the file were replaced, later output would not reach the new one.
int open_descriptor_of(const struct stat& status) {
  for (const int descriptor : {STDOUT_FILENO, STDERR_FILENO}) {
    struct stat open {};
    if (::fstat(descriptor, &open) == 0 && is_same(open, status)) return descriptor;
  }
  return -1;
}

/// Returns the target of a dangling link.
fs::path end_of_dangling(const fs::path& path) {
  fs::path end = path;
  for (int links = 0; fs::is_symlink(fs::symlink_status(end)); ++links) {
    if (links == kMaxLinks) fail(path, ELOOP);
    end = end.parent_path() / fs::read_symlink(end);  // an absolute link replaces the folder
  }
  return end;
}

/// Returns the path of an existing regular file with links resolved, or the path itself if the file
/// is open but no longer has a name (`/dev/fd/3` of a deleted file).
OutputTarget file_target(const fs::path& path, const struct stat& status) {
  std::error_code no_name;
  const fs::path real = fs::canonical(path, no_name);
  struct stat found {};
  const bool is_there = !no_name && ::stat(real.c_str(), &found) == 0 && is_same(found, status);
  if (!is_there) return {OutputTarget::Kind::kNode, path};
  return {OutputTarget::Kind::kFile, real};
}

/// Returns the target of an output path. Follows symbolic links, including dangling ones, and
/// throws std::filesystem::filesystem_error if that is impossible, for example if links form a
/// cycle.
OutputTarget find_output_target(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    if (errno != ENOENT && errno != ENOTDIR) fail(path, errno);
    return {OutputTarget::Kind::kFile, end_of_dangling(path)};
  }
  if (S_ISDIR(status.st_mode)) return {OutputTarget::Kind::kFolder, path};
  if (const int open = open_descriptor_of(status); open >= 0) {
    return {OutputTarget::Kind::kOpen, path, open};
  }
  if (!S_ISREG(status.st_mode)) return {OutputTarget::Kind::kNode, path};
  return file_target(path, status);
}

[[noreturn]] void refuse_output(const fs::path& target, std::string_view why,
                                std::string_view remedy) {
  throw InputError(fmt::format("cannot write '{}': {}; {}", target.string(), why, remedy));
}

fs::path folder_of(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

/// Throws the system's error with a suggested remedy.
[[noreturn]] void refuse_output_error(const fs::path& target, int error) {
  if (error == ENOSPC || error == EDQUOT) {
    refuse_output(target,
                  fmt::format("the disk of the folder '{}' is full", folder_of(target).string()),
                  "make room there or choose another place");
  }
  if (error == EFBIG) {
    refuse_output(target, "it would be larger than the file size limit",
                  "raise the limit (ulimit -f) or choose another disk");
  }
  refuse_output(target, error == 0 ? "the writing failed" : std::strerror(error),
                "choose another place");
}

/// Returns the target of an output path. Throws InputError for a folder.
OutputTarget target_of(const fs::path& target) {
  if (!target.has_filename()) refuse_output(target, "it names a folder", "add a file name");
  try {
    OutputTarget found = find_output_target(target);
    if (found.kind != OutputTarget::Kind::kFolder) return found;
  } catch (const fs::filesystem_error& error) {
    refuse_output(target, error.code().message(), "choose another place");
  }
  refuse_output(target, "it is a folder", "add a file name");
}

/// Sends everything written to a std::ostream to a descriptor. The stream must be flushed at the
/// end, and is bad once a write has failed.
class DescriptorBuffer : public std::streambuf {
 public:
  explicit DescriptorBuffer(int descriptor) : descriptor_(descriptor) {
    setp(buffer_.data(), buffer_.data() + buffer_.size());
  }

  /// Returns errno of the failed write, or 0 if no write failed.
  int error() const { return error_; }

 private:
  int_type overflow(int_type character) override {
    if (!write_out()) return traits_type::eof();
    if (traits_type::eq_int_type(character, traits_type::eof()))
      return traits_type::not_eof(character);
    return sputc(traits_type::to_char_type(character));
  }

  int sync() override { return write_out() ? 0 : -1; }

  bool write_out() {
    const char* next = pbase();
    while (next != pptr()) {
      const ssize_t count = ::write(descriptor_, next, static_cast<std::size_t>(pptr() - next));
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) {
        error_ = errno;
        return false;
      }
      next += count;
    }
    setp(buffer_.data(), buffer_.data() + buffer_.size());
    return true;
  }

  int descriptor_;
  int error_ = 0;
  std::array<char, 1U << 16U> buffer_{};
};

/// Returns nothing on success, otherwise errno of the failed write (0 if the stream itself failed).
std::optional<int> write_into(int descriptor, const std::function<void(std::ostream&)>& write) {
  DescriptorBuffer buffer(descriptor);
  std::ostream stream(&buffer);
  write(stream);
  stream.flush();
  return stream ? std::nullopt : std::optional(buffer.error());
}

/// Waits until the contents of a file or folder are on the disk. Returns false, with errno set, on
/// failure.
bool reaches_disk(int descriptor) {
  // Some file systems have nothing to sync for a folder and return EINVAL.
  return descriptor >= 0 && (::fsync(descriptor) == 0 || errno == EINVAL);
}

/// Writes a temporary file and renames it. After that, a power loss does not bring back the old
/// file.
void replace_file(const fs::path& target, const fs::path& named,
                  const std::function<void(std::ostream&)>& write) {
  const fs::path folder = folder_of(target);
  const fs::path beside = folder / fmt::format(".{}.{}{}{}", target.stem().string(), ::getpid(),
                                               kPartial, target.extension().string());
  const Descriptor file(::open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (file.number() < 0) refuse_output_error(named, errno);
  try {
    if (const auto error = write_into(file.number(), write)) refuse_output_error(named, *error);
    if (!reaches_disk(file.number())) refuse_output_error(named, errno);
    std::error_code error;
    fs::rename(beside, target, error);
    if (error) refuse_output_error(named, error.value());
  } catch (...) {
    std::error_code ignored;
    fs::remove(beside, ignored);
    throw;
  }
  // The folder is also synced, because it holds the new name.
  const Descriptor place(::open(folder.c_str(), O_RDONLY | O_CLOEXEC));
  if (!reaches_disk(place.number())) refuse_output_error(named, errno);
}

/// Writes into a target that is not replaced. A partial write cannot be undone.
void write_through(const fs::path& target, const OutputTarget& found,
                   const std::function<void(std::ostream&)>& write) {
  std::optional<int> error;
  if (found.kind == OutputTarget::Kind::kOpen) {
    std::fflush(nullptr);  // earlier output comes first
    error = write_into(found.descriptor, write);
  } else {
    const Descriptor node(::open(target.c_str(), O_WRONLY | O_TRUNC | O_NOCTTY | O_CLOEXEC));
    if (node.number() < 0) refuse_output_error(target, errno);
    error = write_into(node.number(), write);
  }
  if (!error) return;
  refuse_output(target, *error == 0 ? "the writing failed" : std::strerror(*error),
                "choose another place");
}

}  // namespace

std::string read_input(int descriptor, const std::string& name, std::uint64_t max_bytes) {
  try {
    return read_whole(descriptor, name, max_bytes);
  } catch (const std::bad_alloc&) {
  } catch (const std::length_error&) {  // more than a string can hold
  }
  refuse_input(name, "out of memory", "close other programs, or divide the file");
}

std::string read_input(const fs::path& path, std::uint64_t max_bytes) {
  const OpenInput file(path);
  std::string bytes = read_input(file.descriptor.number(), path.string(), max_bytes);
  if (bytes.empty() && file.is_pipe) refuse_empty_pipe(path.string());
  return bytes;
}

std::string read_text_input(const fs::path& path, std::uint64_t max_bytes) {
  std::string text = read_input(path, max_bytes);
  text.erase(0, text.size() - plain_text(text, path.string()).size());
  return text;
}

struct InputStream::State {
  explicit State(const fs::path& path)
      : file(path), name(path.string()), length(known_length(file.descriptor.number(), name)) {}

  /// Appends to the buffer; returns false at the end of the input.
  bool fill() {
    buffer.erase(0, begin);
    begin = 0;
    const std::size_t used = buffer.size();
    buffer.resize(used + kStreamBlock);
    const std::size_t count = read_some({buffer.data() + used, kStreamBlock});
    buffer.resize(used + count);
    return count > 0;
  }

  std::size_t read_some(std::span<char> into) {
    ssize_t count = 0;
    do {
      count = ::read(file.descriptor.number(), into.data(), std::min(into.size(), kLargestRead));
    } while (count < 0 && errno == EINTR);
    if (count < 0) refuse_input_error(name, errno);
    if (count == 0) require_whole();
    taken += static_cast<std::uint64_t>(count);
    return static_cast<std::size_t>(count);
  }

  void require_whole() const {
    if (taken < length) refuse_short_input(name, taken, length);
    if (taken == 0 && file.is_pipe) refuse_empty_pipe(name);
  }

  OpenInput file;
  std::string name;
  std::uint64_t length;     ///< 0 if unknown
  std::uint64_t taken = 0;  ///< bytes read from the file
  std::string buffer{};
  std::size_t begin = 0;  ///< start in `buffer` of the data not yet returned
};

InputStream::InputStream(const fs::path& path) : state_(std::make_unique<State>(path)) {}
InputStream::~InputStream() = default;
InputStream::InputStream(InputStream&&) noexcept = default;

std::optional<std::string_view> InputStream::line() {
  State& state = *state_;
  const bool is_first = position() == 0;
  for (std::size_t searched = 0;;) {
    const std::string_view rest = std::string_view(state.buffer).substr(state.begin);
    const std::size_t end = rest.find('\n', searched);
    searched = rest.size();
    const bool ended = end == std::string_view::npos && !state.fill();
    if (ended && rest.empty()) return std::nullopt;
    if (!ended && end == std::string_view::npos) {
      if (searched > kLongestLine) {
        refuse_input(state.name, fmt::format("it has a line of more than {} bytes", kLongestLine),
                     "write one record per line");
      }
      continue;
    }
    // At the end of the input, `fill` has moved the remainder to the front.
    std::string_view line = std::string_view(state.buffer).substr(state.begin);
    line = line.substr(0, end);
    state.begin += line.size() + (ended ? 0 : 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (is_first && line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
    return line;
  }
}

std::size_t InputStream::read(std::span<char> buffer) {
  State& state = *state_;
  std::size_t used = std::min(buffer.size(), state.buffer.size() - state.begin);
  std::memcpy(buffer.data(), state.buffer.data() + state.begin, used);
  state.begin += used;
  while (used < buffer.size()) {
    const std::size_t count = state.read_some(buffer.subspan(used));
    if (count == 0) break;
    used += count;
  }
  return used;
}

std::optional<std::uint64_t> InputStream::remaining() const {
  if (state_->length == 0) return std::nullopt;
  return state_->length - std::min(state_->length, position());
}

std::uint64_t InputStream::position() const {
  return state_->taken - (state_->buffer.size() - state_->begin);
}

void require_writable(const fs::path& target) {
  const OutputTarget found = target_of(target);
  if (found.kind == OutputTarget::Kind::kOpen) return;
  if (found.kind == OutputTarget::Kind::kNode) {
    if (::access(target.c_str(), W_OK) != 0) refuse_output_error(target, errno);
    return;
  }
  std::error_code ignored;
  const fs::path folder = folder_of(found.path);
  if (!fs::exists(folder, ignored)) {
    refuse_output(target, fmt::format("the folder '{}' does not exist", folder.string()),
                  "create it or choose another");
  }
  if (!fs::is_directory(folder, ignored)) {
    refuse_output(target, fmt::format("'{}' is not a folder", folder.string()),
                  "choose another place");
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    refuse_output(target, fmt::format("the folder '{}' is not writable", folder.string()),
                  "choose another or change its permissions");
  }
}

void make_folder(const fs::path& folder, std::string_view remedy) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error) return;
  throw InputError(
      fmt::format("cannot make the folder '{}': {}; {}", folder.string(), error.message(), remedy));
}

GrowingFile::GrowingFile(const fs::path& path, std::uint64_t bytes)
    : path_(path),
      descriptor_(::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666)),
      bytes_(bytes) {
  if (descriptor_ < 0) refuse_output_error(path_, errno);
  if (::ftruncate(descriptor_, static_cast<off_t>(bytes_)) != 0) {
    const int error = errno;
    ::close(descriptor_);
    refuse_output_error(path_, error);
  }
}

GrowingFile::~GrowingFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

GrowingFile::GrowingFile(GrowingFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      bytes_(other.bytes_) {}

void GrowingFile::add_line(std::string_view line) {
  const std::string whole = std::string(line) + '\n';
  const auto error = write_into(descriptor_, [&](std::ostream& out) { out << whole; });
  if (!error) {
    bytes_ += whole.size();
    return;
  }
  // Otherwise the next line would be appended to a partial line, and both would be lost.
  if (::ftruncate(descriptor_, static_cast<off_t>(bytes_)) != 0) { /* the reader leaves it out */
  }
  refuse_output_error(path_, *error);
}

bool is_left_behind(const fs::path& path) {
  const std::string name = path.filename().string();
  return name.starts_with('.') && name.find(kPartial) != std::string::npos;
}

void write_file(const fs::path& target, std::string_view text) {
  write_file(target, [text](std::ostream& file) {
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
  });
}

void write_file(const fs::path& target, const std::function<void(std::ostream&)>& write) {
  const OutputTarget found = target_of(target);
  if (found.kind == OutputTarget::Kind::kFile) {
    require_writable(target);
    replace_file(found.path, target, write);
  } else {
    write_through(target, found, write);
  }
}

FolderLock::FolderLock(const std::filesystem::path& folder)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0 || ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  if (errno != EWOULDBLOCK) return;
  ::close(descriptor_);
  throw InputError(fmt::format(
      "another beambench is at work in '{}'; wait until it is done or choose another folder",
      folder.string()));
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

FolderLock::FolderLock(FolderLock&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

}  // namespace beambench
