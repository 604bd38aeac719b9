#pragma once
// Encodes messages as bytes: numbers, strings, and parcels of several tasks or results.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace beambench::cluster {

using Bytes = std::vector<std::byte>;

/// Thrown if a message does not have the form that its tag requires.
class ProtocolError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

static_assert(std::endian::native == std::endian::little, "messages are little-endian");

/// A number, or an enumeration, which is sent as a number.
template <class Value>
concept PlainNumber = std::is_arithmetic_v<Value> || std::is_enum_v<Value>;

/// Appends to a message.
class ByteWriter {
 public:
  explicit ByteWriter(Bytes& bytes) : bytes_(&bytes) {}

  template <PlainNumber Number>
  void put(Number number) {
    append(&number, sizeof number);
  }
  /// Appends all values in order.
  template <class... Values>
  void put(const std::tuple<Values&...>& values) {
    const auto put_one = [this](const auto& value) {
      if constexpr (std::is_convertible_v<decltype(value), std::string_view>) {
        put_text(value);
      } else {
        put(value);
      }
    };
    std::apply([&](const auto&... each) { (put_one(each), ...); }, values);
  }
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

/// Reads a message from its beginning. Throws ProtocolError if it is too short.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  bool at_end() const { return bytes_.empty(); }

  template <PlainNumber Number>
  Number get() {
    Number number{};
    std::memcpy(&number, get_bytes(sizeof number).data(), sizeof number);
    return number;
  }
  /// Reads the values that `ByteWriter::put` wrote.
  template <class... Values>
  void get(const std::tuple<Values&...>& values) {
    const auto get_one = [this]<class Value>(Value& value) {
      if constexpr (PlainNumber<Value>) {
        value = get<Value>();
      } else {
        value = get_text();
      }
    };
    std::apply([&](auto&... each) { (get_one(each), ...); }, values);
  }
  std::span<const std::byte> get_bytes(std::size_t size) {
    if (size > bytes_.size()) throw ProtocolError("a message is too short");
    const auto taken = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return taken;
  }
  /// Returns the remaining bytes.
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

  /// Begins an item; append its bytes to the returned message, then call `end_item` or `drop_item`.
  Bytes& begin_item() {
    head_ = bytes_.size();
    bytes_.resize(head_ + sizeof(ItemHead));
    return bytes_;
  }
  /// Ends an item; `note` is sent with it.
  void end_item(float note = 0.0F) {
    const ItemHead head{static_cast<std::uint32_t>(bytes_.size() - head_ - sizeof(ItemHead)), note};
    std::memcpy(bytes_.data() + head_, &head, sizeof head);
    ++items_;
  }
  void drop_item() { bytes_.resize(head_); }

  std::size_t items() const { return items_; }
  Bytes take() && { return std::move(bytes_); }

 private:
  struct ItemHead {
    std::uint32_t length;
    float note;
  };

  Bytes bytes_;
  std::size_t head_ = 0;  ///< position of the head of the item being written
  std::size_t items_ = 0;
};

struct ParcelItem {
  float note;  ///< for a result: the CPU seconds of its task
  std::span<const std::byte> bytes;
};

/// Reads a parcel. Throws ProtocolError for other bytes.
class ParcelReader {
 public:
  /// `bytes` must outlive the items.
  explicit ParcelReader(std::span<const std::byte> bytes) {
    ByteReader reader(bytes);
    number_ = reader.get<std::uint32_t>();
    while (!reader.at_end()) {
      const auto length = reader.get<std::uint32_t>();
      const auto note = reader.get<float>();
      items_.push_back({note, reader.get_bytes(length)});
    }
  }

  std::uint32_t number() const { return number_; }
  const std::vector<ParcelItem>& items() const { return items_; }

 private:
  std::uint32_t number_;
  std::vector<ParcelItem> items_;
};

}  // namespace beambench::cluster
