#pragma once
// What a structure says of itself after it was built.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace beambench {

/// Sizes of a built structure; 0 where a family has no such thing.
struct Statistics {
  std::uint64_t nodes = 0;         ///< interior nodes and leaves
  std::uint64_t leaves = 0;        ///< empty ones included
  std::uint64_t empty_leaves = 0;  ///< leaves without a reference
  std::uint64_t references = 0;    ///< entries in the leaves' lists of primitives
  std::uint64_t depth = 0;         ///< levels of the deepest leaf, the root being level 1
  std::uint64_t bytes = 0;         ///< memory the structure holds, without the scene
  /// What it runs on where it chooses among several; empty: what the build's flags say.
  std::string instruction_set;
  std::vector<std::pair<std::string, double>> more;  ///< what the family adds, by name
};

}  // namespace beambench
