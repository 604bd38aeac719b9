#pragma once
// What this program was built from and by.

#include <array>
#include <string_view>
#include <utility>

namespace beambench::bench {

struct BuildInfo {
  std::string_view version;
  std::string_view commit;  ///< 40 hexadecimal digits, or "unknown" outside of a git checkout
  bool dirty;               ///< were tracked files changed since that commit?
  std::string_view build_type;
  std::string_view compiler;
  std::string_view flags;
  /// The libraries that were found when the build was configured.
  std::array<std::pair<std::string_view, std::string_view>, 8> libraries;
};

const BuildInfo& build_info();

}  // namespace beambench::bench
