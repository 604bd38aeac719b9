#pragma once
// The loaded Embree: its version, and the instruction set that it runs on, which no device property
// reports, only the text that a verbose device prints.

#include <string>
#include <string_view>

namespace beambench::accel::embree {

/// The version of the Embree library that is loaded: "3.13.5".
std::string embree_version();

/// The configuration of a device on so many threads (at least 1), restricted to
/// `isa` (accel/core/instruction_set.hpp): "threads=1,isa=avx2".
std::string device_config(const std::string& isa, int threads = 1);

/// The widest target that is both supported by the machine and compiled in, of what a verbose
/// device printed: "AVX512"; "unknown" where the text has none.
std::string widest_target(const std::string& printed);

/// What Embree runs on when restricted to `isa`. Found once for each value, by a verbose device
/// that prints on std::cout: no other thread may write there meanwhile.
std::string isa_in_use(const std::string& isa);

/// Throws InputError when the machine lacks `isa`, or Embree restricted to it does not run on it;
/// for "best": when it runs on less than the machine has, since ratios to it would then favor the
/// others.
void require_isa(const std::string& isa);

}  // namespace beambench::accel::embree
