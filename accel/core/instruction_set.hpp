#pragma once
// Restricts structures that use the project's own SIMD to an instruction set, to compare them on
// equal terms.

#include <cstdint>
#include <string>

#include "scenes/base/parameters.hpp"

namespace beambench::accel {

/// Returns the parameter `isa`: "best" (the default) selects the machine's best instruction set;
/// on x86, "avx512", "avx2" and "sse4" restrict the structure.
ParameterInfo isa_parameter();

/// Returns whether this machine and the compiled code support a value of `isa_parameter`.
bool is_available(const std::string& isa);

/// Returns the Highway targets that a value of `isa_parameter` allows. Throws InputError if this
/// machine or the compiled code supports none of them.
std::int64_t targets_of(const std::string& isa);

/// Restricts all of this program's kernels, except Embree's, to a value of `isa_parameter`. Call it
/// before building a structure. Throws like `targets_of`.
void restrict_to(const std::string& isa);

/// Returns Highway's name for the best available target, such as "AVX3".
std::string best_simd_target();

}  // namespace beambench::accel
