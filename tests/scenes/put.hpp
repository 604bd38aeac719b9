#pragma once
// Writes binary files for tests.

#include <string>

namespace beambench::tests {

/// Appends the bytes of a value as they are in this machine's memory.
template <typename T>
void put(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

}  // namespace beambench::tests
