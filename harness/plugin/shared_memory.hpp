#pragma once
// Memory that another process maps by a path.

#include <cstddef>
#include <string>

namespace beambench::plugin {

/// An anonymous file in memory. It grows and never shrinks.
class SharedMemory {
 public:
  /// Throws std::system_error if the system does not provide such memory.
  SharedMemory();
  ~SharedMemory();
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;

  /// Returns the memory, of at least `bytes` bytes; earlier addresses become invalid. Throws
  /// std::system_error.
  std::byte* at_least(std::size_t bytes);
  std::byte* data() const { return data_; }
  /// Returns the path by which other processes of the same user can open the memory while this
  /// object exists.
  std::string path() const;

 private:
  int descriptor_;
  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace beambench::plugin
