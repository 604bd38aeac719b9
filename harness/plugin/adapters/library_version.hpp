#pragma once
// The version of a library, as stated in rows of results.

#include <string>

namespace adapters {

/// Returns "tinybvh 1.6.8 (fbd8b60)": `version` and the commit of its sources, if CMake found that
/// they are a git checkout.
inline std::string library_version(const std::string& version) {
  const std::string commit = BEAMBENCH_LIBRARY_COMMIT;
  return commit.empty() ? version : version + " (" + commit + ")";
}

}  // namespace adapters
