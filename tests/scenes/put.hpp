#pragma once
// Binary files of tests.

#include <string>

namespace beambench::tests {

/// Appends the bytes of a value, as this machine has them in memory.
template <typename T>
void put(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

}  // namespace beambench::tests
