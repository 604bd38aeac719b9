#pragma once
// Which Embree answers: for the manifest of a run.

#include <string>

namespace beambench::accel::embree {

/// The version of the Embree library that is loaded: "3.13.5".
std::string embree_version();

/// The instruction set that Embree runs on unless it is held to less (parameter `isa`): "AVX512".
/// The first call must not run while other threads write to std::cout (accel/embree/isa.hpp).
std::string embree_isa();

}  // namespace beambench::accel::embree
