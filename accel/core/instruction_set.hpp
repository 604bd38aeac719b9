#pragma once
// Instruction sets that structures with SIMD of their own can be held to, so that they compare on
// equal terms.

#include <cstdint>
#include <string>

#include "scenes/core/parameters.hpp"

namespace beambench::accel {

/// `isa`: "best" (the default) leaves the choice to the machine, "avx512", "avx2" and "sse4" hold
/// the structure to less than it may have.
ParameterInfo isa_parameter();

/// Highway's targets that a value of `isa_parameter` allows. Throws InputError when this machine
/// (or what was compiled for it) has none of them.
std::int64_t targets_of(const std::string& isa);

/// Highway's name for the best of them: "AVX3".
std::string best_simd_target();

}  // namespace beambench::accel
