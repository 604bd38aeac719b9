#pragma once
// Numbers and texts as the bytes of a message.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace beambench::cluster {

using Bytes = std::vector<std::byte>;

/// A message is not what its kind says: sender and receiver do not speak the same protocol.
class ProtocolError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

static_assert(std::endian::native == std::endian::little, "messages are little-endian");

/// Appends to a message.
class ByteWriter {
 public:
  explicit ByteWriter(Bytes& bytes) : bytes_(&bytes) {}

  template <class Number>
  requires std::is_arithmetic_v<Number>
  void put(Number number) { append(&number, sizeof number); }
  void put_bytes(std::span<const std::byte> bytes) { append(bytes.data(), bytes.size()); }
  void put_text(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size()));
    append(text.data(), text.size());
  }

 private:
  void append(const void* from, std::size_t size) {
    if (size == 0) return;
    const std::size_t end = bytes_->size();
    bytes_->resize(end + size);
    std::memcpy(bytes_->data() + end, from, size);
  }

  Bytes* bytes_;
};

/// Takes a message apart, from its beginning on. Throws ProtocolError where it is too short.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  bool at_end() const { return bytes_.empty(); }

  template <class Number>
  requires std::is_arithmetic_v<Number> Number get() {
    Number number{};
    std::memcpy(&number, get_bytes(sizeof number).data(), sizeof number);
    return number;
  }
  std::span<const std::byte> get_bytes(std::size_t size) {
    if (size > bytes_.size()) throw ProtocolError("a message is shorter than it should be");
    const auto taken = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return taken;
  }
  /// All that is left.
  std::span<const std::byte> rest() { return get_bytes(bytes_.size()); }
  std::string get_text() {
    const auto taken = get_bytes(get<std::uint32_t>());
    return {reinterpret_cast<const char*>(taken.data()), taken.size()};
  }

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace beambench::cluster
