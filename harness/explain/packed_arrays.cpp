#include "harness/explain/packed_arrays.hpp"

#include <algorithm>
#include <cstddef>
#include <new>

#include <zlib.h>

namespace beambench::explain {

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - at);
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      group = group << 8U | (i < count ? static_cast<std::uint8_t>(bytes[at + i]) : 0U);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      text += i <= count ? kDigits[group >> (18U - 6U * i) & 63U] : '=';
    }
  }
  return text;
}

std::string PackedArrays::text() const {
  uLongf size = compressBound(bytes_.size());
  std::string packed(size, '\0');
  const int result = compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                               reinterpret_cast<const Bytef*>(bytes_.data()), bytes_.size(),
                               Z_DEFAULT_COMPRESSION);
  if (result != Z_OK) throw std::bad_alloc();  // the only failure possible here
  packed.resize(size);
  return base64(packed);
}

}  // namespace beambench::explain
