#pragma once
// The loaded Embree: its version and instruction set. The instruction set is not a device property;
// it appears only in the output of a verbose device.

#include <string>
#include <string_view>

namespace beambench::accel::embree {

/// Returns the version of the loaded Embree library: "3.13.5".
std::string embree_version();

/// Returns the configuration of a device with `threads` threads (at least 1), restricted to `isa`
/// (accel/core/instruction_set.hpp): "threads=1,isa=avx2".
std::string device_config(const std::string& isa, int threads = 1);

/// Returns the widest target that is both supported by the machine and compiled in, such as
/// "AVX512", from the output of a verbose device, or "unknown" if the output names no such target.
std::string widest_target(const std::string& printed);

/// Returns the instruction set that Embree uses when restricted to `isa`. It is determined once for
/// each value by a verbose device that prints on std::cout, so no other thread may write to
/// std::cout at the same time.
std::string isa_in_use(const std::string& isa);

/// Throws InputError if the machine lacks `isa`, or if Embree restricted to `isa` does not use it.
/// For "best", throws if Embree uses less than the machine supports, because ratios to Embree would
/// then favor the other structures.
void require_isa(const std::string& isa);

}  // namespace beambench::accel::embree
