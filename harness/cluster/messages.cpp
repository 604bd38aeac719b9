#include "harness/cluster/messages.hpp"

#include <cstring>

namespace beambench::cluster {
namespace {

/// Before each item.
struct ItemHead {
  std::uint32_t length;
  float note;
};

}  // namespace

Bytes& ParcelWriter::begin_item() {
  head_ = bytes_.size();
  bytes_.resize(head_ + sizeof(ItemHead));
  return bytes_;
}

void ParcelWriter::end_item(float note) {
  const ItemHead head{static_cast<std::uint32_t>(bytes_.size() - head_ - sizeof(ItemHead)), note};
  std::memcpy(bytes_.data() + head_, &head, sizeof head);
  ++items_;
}

ParcelReader::ParcelReader(std::span<const std::byte> bytes) {
  ByteReader reader(bytes);
  number_ = reader.get<std::uint32_t>();
  while (!reader.at_end()) {
    const auto length = reader.get<std::uint32_t>();
    const auto note = reader.get<float>();
    items_.push_back({note, reader.get_bytes(length)});
  }
}

}  // namespace beambench::cluster
