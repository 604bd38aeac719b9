#pragma once
// Messages as bytes: numbers, texts, and parcels of several tasks or results.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace beambench::cluster {

using Bytes = std::vector<std::byte>;

/// A message does not have the form that its tag requires.
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

/// Reads a message from its beginning. Throws ProtocolError where it is too short.
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

/// Several tasks in one message, or their results.
class ParcelWriter {
 public:
  explicit ParcelWriter(std::uint32_t number) { ByteWriter(bytes_).put(number); }

  /// Begins an item; its bytes are appended to the returned message. `end_item` or `drop_item`
  /// follows.
  Bytes& begin_item();
  /// `note` goes with the item.
  void end_item(float note = 0.0F);
  void drop_item() { bytes_.resize(head_); }

  std::size_t items() const { return items_; }
  Bytes take() && { return std::move(bytes_); }

 private:
  Bytes bytes_;
  std::size_t head_ = 0;  ///< of the item being written
  std::size_t items_ = 0;
};

struct ParcelItem {
  float note;  ///< of a result: the CPU seconds that its task took
  std::span<const std::byte> bytes;
};

/// Reads a parcel. Throws ProtocolError for other bytes.
class ParcelReader {
 public:
  /// `bytes` must outlive the items.
  explicit ParcelReader(std::span<const std::byte> bytes);

  std::uint32_t number() const { return number_; }
  const std::vector<ParcelItem>& items() const { return items_; }

 private:
  std::uint32_t number_;
  std::vector<ParcelItem> items_;
};

}  // namespace beambench::cluster
