#pragma once
// Memory in 2 MiB pages.

#include <cstddef>
#include <new>
#include <vector>

#include <sys/mman.h>

namespace beambench::accel {

/// Allocates arrays of many megabytes with scattered accesses: with 4 KiB pages most accesses miss
/// the TLB, and the first touch of a page costs more than writing its contents. Linux provides 2
/// MiB pages on request ("madvise"); otherwise, ordinary pages are used. The memory always begins
/// at a cache line.
template <class T>
struct LargePages {
  using value_type = T;
  static constexpr std::size_t kPage = std::size_t{1} << 21U;
  static constexpr std::size_t kLine = 64;

  LargePages() = default;
  template <class U>
  explicit LargePages(const LargePages<U>&) {}

  T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    void* const memory = ::operator new(bytes, alignment(bytes));
#if defined(MADV_HUGEPAGE)
    // This is only a request; if it is refused, results are the same.
    if (bytes >= kPage) static_cast<void>(::madvise(memory, bytes, MADV_HUGEPAGE));
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) {
    ::operator delete(memory, alignment(count * sizeof(T)));
  }
  friend bool operator==(const LargePages&, const LargePages&) { return true; }

 private:
  static std::align_val_t alignment(std::size_t bytes) {
    return std::align_val_t{bytes >= kPage ? kPage : kLine};
  }
};

template <class T>
using LargePageVector = std::vector<T, LargePages<T>>;

}  // namespace beambench::accel
