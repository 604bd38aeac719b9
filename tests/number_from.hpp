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

/// Returns `full` where BEAMBENCH_FULL is set, as `scripts/test --full` sets it, otherwise `usual`.
inline std::uint64_t in_full(std::uint64_t full, std::uint64_t usual) {
  return std::getenv("BEAMBENCH_FULL") != nullptr ? full : usual;
}

}  // namespace beambench::tests
