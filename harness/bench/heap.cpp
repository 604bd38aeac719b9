#include "harness/bench/heap.hpp"

#include <cstdlib>

#if defined(__GLIBC__) && __GLIBC_PREREQ(2, 33)
#include <malloc.h>
#define BEAMBENCH_HAS_MALLINFO2 1
#else
#define BEAMBENCH_HAS_MALLINFO2 0
#endif

namespace beambench::bench {

std::optional<std::uint64_t> heap_in_use() {
#if BEAMBENCH_HAS_MALLINFO2
  const struct mallinfo2 info = ::mallinfo2();
  const std::uint64_t bytes =
      info.uordblks + info.hblkhd;  // in arenas, and mapped for large blocks
  if (bytes > 0) return bytes;      // a replaced allocator (a sanitizer's) says 0
#endif
  return std::nullopt;
}

std::optional<std::uint64_t> heap_growth(std::optional<std::uint64_t> before,
                                         std::optional<std::uint64_t> after) {
  if (!before || !after) return std::nullopt;
  return *after > *before ? *after - *before : 0;
}

}  // namespace beambench::bench
