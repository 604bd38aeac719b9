#pragma once
// Instruction sets to which structures with SIMD of their own can be restricted, to compare them on
// equal terms.

#include <cstdint>
#include <string>

#include "scenes/base/parameters.hpp"

namespace beambench::accel {

/// Returns the parameter `isa`: "best" (the default) is the best that the machine has; "avx512",
/// "avx2" and "sse4" restrict the structure.
ParameterInfo isa_parameter();

/// Returns Highway's targets that a value of `isa_parameter` allows. Throws InputError when this
/// machine (or the compiled code) has none of them.
std::int64_t targets_of(const std::string& isa);

/// Restricts all of this program's kernels to a value of `isa_parameter`, Embree's excepted. Call
/// it before a structure is built. Throws like `targets_of`.
void restrict_to(const std::string& isa);

/// Returns Highway's name for the best of them: "AVX3".
std::string best_simd_target();

}  // namespace beambench::accel
