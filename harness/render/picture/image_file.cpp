#include "harness/render/picture/image_file.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include "harness/render/picture/color.hpp"
#include "harness/render/picture/image_encoder.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/files.hpp"

namespace beambench::render {
namespace {

constexpr std::size_t kValueBytes = 4;  // of every EXR channel here: float or uint32

StoredImage stored(const Image& image, StoredType type) {
  return {image.width(), image.height(), {{"R", type}, {"G", type}, {"B", type}}, {}};
}

std::uint8_t to_byte(float encoded) {
  return static_cast<std::uint8_t>(std::lround(255.0F * encoded));
}

StoredImage png_image(const Image& image) {
  StoredImage result = stored(image, StoredType::kByte);
  for (const glm::vec3& pixel : image.pixels()) {
    const glm::vec3 encoded = srgb_from_linear(pixel);
    result.bytes.insert(result.bytes.end(),
                        {to_byte(encoded.x), to_byte(encoded.y), to_byte(encoded.z)});
  }
  return result;
}

/// Returns an image in which each value has its channel's type.
StoredImage exr_image(const Image& image, std::span<const DataChannel> data) {
  StoredImage result = stored(image, StoredType::kFloat);
  for (const DataChannel& channel : data) {
    const bool is_float = std::holds_alternative<std::vector<float>>(channel.values);
    result.channels.push_back({channel.name, is_float ? StoredType::kFloat : StoredType::kUint32});
  }
  const auto append = [&](const auto& value) {
    const auto raw = std::bit_cast<std::array<std::uint8_t, kValueBytes>>(value);
    result.bytes.insert(result.bytes.end(), raw.begin(), raw.end());
  };
  for (std::size_t pixel = 0; pixel < image.pixels().size(); ++pixel) {
    const glm::vec3& color = image.pixels()[pixel];
    for (int channel = 0; channel < 3; ++channel) append(color[channel]);
    for (const DataChannel& channel : data) {
      std::visit([&](const auto& values) { append(values[pixel]); }, channel.values);
    }
  }
  return result;
}

void require_complete(const Image& image, std::span<const DataChannel> data) {
  for (const DataChannel& channel : data) {
    if (std::visit([](const auto& values) { return values.size(); }, channel.values) !=
        image.pixels().size()) {
      throw std::logic_error("channel '" + channel.name +
                             "' does not have one value for each pixel");
    }
  }
}

}  // namespace

ImageFormat image_format(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  if (ending == ".png") return ImageFormat::kPng;
  if (ending == ".exr") return ImageFormat::kExr;
  throw InputError(
      fmt::format("the picture '{}' has no known file extension; use .png (8-bit sRGB) or .exr "
                  "(float, with depth and ids)",
                  file.string()));
}

void write_image(const std::filesystem::path& file, const Image& image,
                 std::span<const DataChannel> data) {
  const ImageFormat format = image_format(file);
  require_complete(image, data);
  const StoredImage pixels =
      format == ImageFormat::kPng ? png_image(image) : exr_image(image, data);
  EncodedImage encoded;
  image_encoder()(file.string(), pixels, encoded);
  if (encoded.bytes.empty()) {
    throw InputError(
        fmt::format("cannot write the picture '{}': {}; choose another place or format",
                    file.string(), encoded.error));
  }
  write_file(file, std::string_view(reinterpret_cast<const char*>(encoded.bytes.data()),
                                    encoded.bytes.size()));
}

}  // namespace beambench::render
