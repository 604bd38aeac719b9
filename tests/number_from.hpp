#pragma once
// Numbers from the environment that scale tests.

#include <cstdint>
#include <cstdlib>
#include <string>

namespace beambench::tests {

/// Returns the number in an environment variable, or `otherwise` if it is not set.
inline std::uint64_t number_from(const char* variable, std::uint64_t otherwise) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? otherwise : std::stoull(text);
}

/// Returns `full` if BEAMBENCH_FULL is set, as by `scripts/test --full`, otherwise `usual`.
inline std::uint64_t in_full(std::uint64_t full, std::uint64_t usual) {
  return std::getenv("BEAMBENCH_FULL") != nullptr ? full : usual;
}

}  // namespace beambench::tests
