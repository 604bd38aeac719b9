#pragma once
// Tasks on their way to a consumer, and their results on the way back.

#include <cstdint>
#include <span>
#include <vector>

#include "harness/cluster/bytes.hpp"

namespace beambench::cluster {

/// Several tasks in one message, or the results of all of them. What a task or a result is, others
/// know.
class ParcelWriter {
 public:
  explicit ParcelWriter(std::uint32_t number) { ByteWriter(bytes_).put(number); }

  /// Begins an item; its bytes are to be appended to what is returned. `end_item` or `drop_item`
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

/// A parcel taken apart. Throws ProtocolError where it is none.
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
