#pragma once
// The control word of a thread's floating-point arithmetic: MXCSR on x86, FPCR on ARM.

#include <cstdint>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace beambench::accel {

#if defined(__SSE2__)
/// The bits that flush subnormal results to zero and treat subnormal operands as zero; 0 on a
/// processor whose control word is unknown.
inline constexpr std::uint32_t kFlushSubnormals = 0x8040;
/// The control word of a new thread: round to nearest, exceptions masked.
inline constexpr std::uint32_t kInitialFloatMode = 0x1F80;
/// Returns the calling thread's control word.
inline std::uint32_t float_mode() { return _mm_getcsr(); }
/// Sets the calling thread's control word.
inline void set_float_mode(std::uint32_t mode) { _mm_setcsr(mode); }
#elif defined(__aarch64__)
inline constexpr std::uint32_t kFlushSubnormals = 0x0100'0000;
inline constexpr std::uint32_t kInitialFloatMode = 0;
inline std::uint32_t float_mode() {
  std::uint64_t word = 0;
  asm volatile("mrs %0, fpcr" : "=r"(word));
  return static_cast<std::uint32_t>(word);
}
inline void set_float_mode(std::uint32_t mode) {
  asm volatile("msr fpcr, %0" : : "r"(std::uint64_t{mode}));
}
#else
inline constexpr std::uint32_t kFlushSubnormals = 0;
inline constexpr std::uint32_t kInitialFloatMode = 0;
inline std::uint32_t float_mode() { return 0; }
inline void set_float_mode(std::uint32_t) {}
#endif

}  // namespace beambench::accel
