#pragma once
// What the C library's allocator has handed out.

#include <cstdint>
#include <optional>

namespace beambench::bench {

/// Bytes in use in all of the heap, headers and rounding included, by glibc's mallinfo2; nothing
/// where the allocator does not tell. Memory that a library maps past the allocator is not in it.
std::optional<std::uint64_t> heap_in_use();

/// By how much it grew from one asking to the other; 0 when it shrank, nothing when one is missing.
std::optional<std::uint64_t> heap_growth(std::optional<std::uint64_t> before,
                                         std::optional<std::uint64_t> after);

}  // namespace beambench::bench
