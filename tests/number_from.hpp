#pragma once
// Numbers from the environment, by which tests are made larger or smaller.

#include <cstdint>
#include <cstdlib>
#include <string>

namespace beambench::tests {

/// Returns the number in an environment variable, or `otherwise` where it is not set.
inline std::uint64_t number_from(const char* variable, std::uint64_t otherwise) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? otherwise : std::stoull(text);
}

}  // namespace beambench::tests
