#pragma once
// Where the running code lies, and so what is installed beside it.

#include <filesystem>

namespace beambench::base {

/// Returns the folder of the program or shared object that this code was linked into.
std::filesystem::path code_folder();

}  // namespace beambench::base
