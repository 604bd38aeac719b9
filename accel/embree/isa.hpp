#pragma once
// The instruction set that Embree runs on. No device property tells it: only what a verbose device
// prints does.

#include <string>
#include <string_view>

namespace beambench::accel::embree {

/// The configuration of a device on so many threads (0: one for each core), held to `isa`
/// (accel/core/instruction_set.hpp): "threads=1,isa=avx2".
std::string device_config(const std::string& isa, int threads = 1);

/// The widest target that is both supported by the machine and compiled in, of what a verbose
/// device printed: "AVX512"; "unknown" where the text does not tell.
std::string widest_target(const std::string& printed);

/// What Embree runs on when held to `isa`. Found once for each value, by a verbose device that
/// prints on std::cout: no other thread may write there meanwhile.
std::string isa_in_use(const std::string& isa);

/// Throws InputError when the machine lacks `isa`, or Embree held to it does not run on it; for
/// "best": when it runs on less than the machine has, since ratios to it would then flatter the
/// others.
void require_isa(const std::string& isa);

}  // namespace beambench::accel::embree
