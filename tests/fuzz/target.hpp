#pragma once
// The parts of every fuzz target, and the two allowed outcomes of a reader.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

#include "scenes/base/error.hpp"

/// The entry point of a target: libFuzzer calls it with its own inputs, replay.cpp with the
/// contents of files. Returns 0. Anything that ends the process or throws is a fault of the reader.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace beambench::fuzz {

/// Returns the input as text.
inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Returns the result of a reader for an input; nothing if the reader refuses it with InputError,
/// the only allowed way. Propagates all other exceptions.
template <class Read>
std::optional<std::invoke_result_t<Read>> accepted(Read&& read) {
  try {
    return std::invoke(read);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

/// Throws std::logic_error unless a property that every input must have holds.
inline void require(bool holds, const char* claim) {
  if (!holds) throw std::logic_error(claim);
}

}  // namespace beambench::fuzz
