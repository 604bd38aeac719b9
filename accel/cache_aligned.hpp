#pragma once
// Memory that begins with a cache line.

#include <cstddef>
#include <new>
#include <vector>

namespace beambench {

/// For arrays that are written line by line, past the caches: a store that shares no line with
/// another array needs no reading.
template <class T>
struct CacheAligned {
  using value_type = T;
  static constexpr std::align_val_t kLine{64};

  CacheAligned() = default;
  template <class U>
  explicit CacheAligned(const CacheAligned<U>&) {}

  T* allocate(std::size_t count) {
    return static_cast<T*>(::operator new(count * sizeof(T), kLine));
  }
  void deallocate(T* memory, std::size_t) { ::operator delete(memory, kLine); }

  friend bool operator==(const CacheAligned&, const CacheAligned&) { return true; }
};

template <class T>
using CacheAlignedVector = std::vector<T, CacheAligned<T>>;

}  // namespace beambench
