#pragma once
// What every fuzz target consists of, and the two answers that a reader may give.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

#include "scenes/base/error.hpp"

/// The entry of a target: libFuzzer calls it with inputs of its own, replay.cpp with those of
/// files. Returns 0. Whatever ends the process or throws is a fault of the reader.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace beambench::fuzz {

/// The input as text.
inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// What a reader makes of an input; nothing where it refuses it by InputError, the only way in
/// which it may. Passes on whatever else it throws.
template <class Read>
std::optional<std::invoke_result_t<Read>> accepted(Read&& read) {
  try {
    return std::invoke(read);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

/// Throws std::logic_error unless what must be true of every input is.
inline void require(bool holds, const char* claim) {
  if (!holds) throw std::logic_error(claim);
}

}  // namespace beambench::fuzz
