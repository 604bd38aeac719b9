#include "harness/plugin/shared_memory.hpp"

#include <cerrno>
#include <system_error>

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

namespace beambench::plugin {
namespace {

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

}  // namespace

SharedMemory::SharedMemory() : descriptor_(::memfd_create("beambench", MFD_CLOEXEC)) {
  if (descriptor_ < 0) fail("memory to share with a program");
}

SharedMemory::~SharedMemory() {
  if (data_ != nullptr) ::munmap(data_, size_);
  ::close(descriptor_);
}

std::byte* SharedMemory::at_least(std::size_t bytes) {
  if (bytes <= size_) return data_;
  if (::ftruncate(descriptor_, static_cast<off_t>(bytes)) != 0) fail("more memory to share");
  void* mapped = data_ == nullptr
                     ? ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_, 0)
                     : ::mremap(data_, size_, bytes, MREMAP_MAYMOVE);
  if (mapped == MAP_FAILED) fail("more memory to share");
  data_ = static_cast<std::byte*>(mapped);
  size_ = bytes;
  return data_;
}

std::string SharedMemory::path() const {
  return fmt::format("/proc/{}/fd/{}", ::getpid(), descriptor_);
}

}  // namespace beambench::plugin
