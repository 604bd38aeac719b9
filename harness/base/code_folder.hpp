#pragma once
// Finds the folder of the running code, and thereby the files installed with it.

#include <filesystem>

namespace beambench::base {

/// Returns the folder of the program or shared object that this code was linked into.
std::filesystem::path code_folder();

}  // namespace beambench::base
