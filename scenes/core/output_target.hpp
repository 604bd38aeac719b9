#pragma once
// What output to a path is written onto.

#include <filesystem>

namespace beambench {

/// What a path given for output stands for.
struct OutputTarget {
  enum class Kind {
    kFile,    ///< a regular file, there or to be made: written aside and renamed onto
    kFolder,  ///< cannot be written
    kNode,    ///< a device, a pipe or a socket: written into, never replaced
    kOpen     ///< what the standard output or error already goes to: written behind it
  };
  Kind kind;
  std::filesystem::path path;  ///< with symbolic links followed to their end; of a kNode as given
  int descriptor = -1;         ///< of a kOpen
};

/// Follows symbolic links, dangling ones too. Throws std::filesystem::filesystem_error when that
/// cannot be done, as for links that lead round in a circle.
OutputTarget find_output_target(const std::filesystem::path& path);

}  // namespace beambench
