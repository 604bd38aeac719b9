#pragma once
// Finds the folder of the running code, and with it the files installed there.

#include <filesystem>

namespace beambench::base {

/// Returns the folder of the program or shared object into which this code was linked.
std::filesystem::path code_folder();

}  // namespace beambench::base
