// A small version of image_encoder.hpp's shared object, without OpenImageIO and its two hundred
// libraries: writes PNG with libpng and EXR with tinyexr.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <string>
#include <type_traits>
#include <vector>

#include <png.h>
#include <tinyexr.h>

#include "harness/render/picture/image_encoder.hpp"

namespace beambench::render {
namespace {

void encode_png(const StoredImage& image, EncodedImage& encoded) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  encoded.bytes.resize(size);
  const int done = png_image_write_to_memory(&png, encoded.bytes.data(), &size, 0,
                                             image.bytes.data(), 0, nullptr);
  encoded.bytes.resize(done != 0 ? size : 0);
  encoded.error = png.message;
}

int exr_type(StoredType type) {
  return type == StoredType::kFloat ? TINYEXR_PIXELTYPE_FLOAT : TINYEXR_PIXELTYPE_UINT;
}

/// Returns the channels in the order of the format: by name.
std::vector<std::size_t> in_order(const std::vector<StoredChannel>& channels) {
  std::vector<std::size_t> order(channels.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t at) { return channels[at].name; });
  return order;
}

void encode_exr(const StoredImage& image, EncodedImage& encoded) {
  using Value = std::array<unsigned char, 4>;  // of any channel: float or uint32
  const std::size_t count = image.channels.size();
  const std::size_t pixels = image.bytes.size() / (count * sizeof(Value));
  std::vector<std::vector<Value>> planes;
  std::vector<unsigned char*> pointers;
  std::vector<EXRChannelInfo> infos(count);
  std::vector<int> types;
  for (const std::size_t channel : in_order(image.channels)) {
    const StoredChannel& stored = image.channels[channel];
    // The last byte of the name stays 0.
    stored.name.copy(infos[types.size()].name, sizeof(EXRChannelInfo::name) - 1);
    types.push_back(exr_type(stored.type));
    std::vector<Value>& plane = planes.emplace_back(pixels);
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
      const std::size_t from = (pixel * count + channel) * sizeof(Value);
      std::copy_n(image.bytes.data() + from, sizeof(Value), plane[pixel].begin());
    }
  }
  for (std::vector<Value>& plane : planes) pointers.push_back(plane.front().data());

  EXRHeader header;
  InitEXRHeader(&header);
  header.num_channels = static_cast<int>(count);
  header.channels = infos.data();
  header.pixel_types = types.data();
  header.requested_pixel_types = types.data();
  header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;
  EXRImage exr;
  InitEXRImage(&exr);
  exr.num_channels = static_cast<int>(count);
  exr.images = pointers.data();
  exr.width = image.width;
  exr.height = image.height;
  unsigned char* memory = nullptr;
  const char* error = nullptr;
  const std::size_t size = SaveEXRImageToMemory(&exr, &header, &memory, &error);
  // tinyexr allocates it with malloc.
  const std::unique_ptr<unsigned char, decltype(&std::free)> owner(memory, &std::free);
  if (size > 0) encoded.bytes.assign(memory, memory + size);
  if (error != nullptr) {
    encoded.error = error;
    FreeEXRErrorMessage(error);
  }
}

}  // namespace

extern "C" void beambench_encode_image(const std::string&, const StoredImage& image,
                                       EncodedImage& encoded) {
  const bool is_png = image.channels.front().type == StoredType::kByte;
  is_png ? encode_png(image, encoded) : encode_exr(image, encoded);
  if (encoded.bytes.empty() && encoded.error.empty()) encoded.error = "the library gives no reason";
}
// The loader of the shared object assumes this type.
static_assert(std::is_same_v<decltype(beambench_encode_image), EncodeImage>);

}  // namespace beambench::render
