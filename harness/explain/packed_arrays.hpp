#pragma once
// Arrays of numbers for a page, as one compressed block of bytes, encoded as a string.

#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace beambench::explain {

/// Collects arrays of little-endian numbers. JSON describes where each array is; the page gets all
/// bytes in one string.
class PackedArrays {
 public:
  /// Adds an array and returns its description: `type` (the name of JavaScript's typed array
  /// without "Array"), `at` (the offset of its first byte, a multiple of 4) and `count`.
  nlohmann::json add(std::span<const float> values) { return append("Float32", values); }
  nlohmann::json add(std::span<const std::uint32_t> values) { return append("Uint32", values); }
  nlohmann::json add(std::span<const std::uint16_t> values) { return append("Uint16", values); }
  nlohmann::json add(std::span<const std::uint8_t> values) { return append("Uint8", values); }

  /// Returns all bytes, compressed by zlib and encoded in base64.
  std::string text() const;

 private:
  static_assert(std::endian::native == std::endian::little);

  template <class Number>
  nlohmann::json append(std::string_view type, std::span<const Number> values) {
    const nlohmann::json place{{"type", type}, {"at", bytes_.size()}, {"count", values.size()}};
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    return place;
  }

  std::string bytes_;
};

/// Returns the base64 encoding (RFC 4648) of bytes, with padding.
std::string base64(std::string_view bytes);

}  // namespace beambench::explain
