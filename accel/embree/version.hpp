#pragma once
// Which Embree answers: for the manifest of a run.

#include <string>

namespace beambench {

/// The version of the Embree library that is loaded: "3.13.5".
std::string embree_version();

/// The widest instruction set that Embree uses on this machine: "AVX2", "AVX512". Found once, by
/// what a verbose device says of itself on std::cout: no device property tells it. The first call
/// must not run while other threads write to std::cout.
std::string embree_isa();

}  // namespace beambench
