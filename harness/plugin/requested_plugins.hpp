#pragma once
// Which plug-ins a command line asks for.

#include <string>
#include <vector>

namespace beambench::plugin {

/// Takes `--plugin FILE` and `--plugin=FILE` off a command line (the program's name first),
/// wherever they stand before a `--`. The files of the environment's BEAMBENCH_PLUGINS come first:
/// separated by colons, each a file, or a folder of which all `*.so` are meant, by name. Each file
/// once. Throws InputError when a file is missing behind the option.
std::vector<std::string> take_requested_plugins(std::vector<std::string>& arguments);

}  // namespace beambench::plugin
