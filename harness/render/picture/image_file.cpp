#include "harness/render/picture/image_file.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string_view>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "harness/render/picture/color.hpp"
#include "scenes/core/error.hpp"
#include "scenes/core/files.hpp"

namespace beambench::render {
namespace {

constexpr std::size_t kValueBytes = 4;  // of every EXR channel here: float or uint32

std::uint8_t to_byte(float encoded) {
  return static_cast<std::uint8_t>(std::lround(255.0F * encoded));
}

std::vector<std::uint8_t> png_pixels(const Image& image) {
  std::vector<std::uint8_t> bytes;
  for (const glm::vec3& pixel : image.pixels()) {
    const glm::vec3 encoded = srgb_from_linear(pixel);
    bytes.insert(bytes.end(), {to_byte(encoded.x), to_byte(encoded.y), to_byte(encoded.z)});
  }
  return bytes;
}

/// A pixel's values are together, each in its channel's own type.
std::vector<std::uint8_t> exr_pixels(const Image& image, std::span<const DataChannel> data) {
  std::vector<std::uint8_t> bytes;
  const auto append = [&](const auto& value) {
    const auto raw = std::bit_cast<std::array<std::uint8_t, kValueBytes>>(value);
    bytes.insert(bytes.end(), raw.begin(), raw.end());
  };
  for (std::size_t pixel = 0; pixel < image.pixels().size(); ++pixel) {
    const glm::vec3& color = image.pixels()[pixel];
    for (int channel = 0; channel < 3; ++channel) append(color[channel]);
    for (const DataChannel& channel : data) {
      std::visit([&](const auto& values) { append(values[pixel]); }, channel.values);
    }
  }
  return bytes;
}

OIIO::ImageSpec exr_spec(const Image& image, std::span<const DataChannel> data) {
  OIIO::ImageSpec spec(image.width(), image.height(), 3 + static_cast<int>(data.size()),
                       OIIO::TypeDesc::FLOAT);
  spec.channelformats.assign(3, OIIO::TypeDesc::FLOAT);
  for (const DataChannel& channel : data) {
    const bool is_float = std::holds_alternative<std::vector<float>>(channel.values);
    spec.channelnames[spec.channelformats.size()] = channel.name;
    spec.channelformats.emplace_back(is_float ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT32);
  }
  spec.attribute("compression", "zip");
  // OpenImageIO states the time of writing unless it is given one: equal pictures would differ.
  spec.attribute("DateTime", "1970:01:01 00:00:00");
  return spec;
}

void require_complete(const Image& image, std::span<const DataChannel> data) {
  for (const DataChannel& channel : data) {
    if (std::visit([](const auto& values) { return values.size(); }, channel.values) !=
        image.pixels().size()) {
      throw std::logic_error("channel '" + channel.name + "' has not one value for each pixel");
    }
  }
}

/// Encoded in memory and written by us: OpenImageIO does not notice when a disk is full.
void write(const std::filesystem::path& target, const OIIO::ImageSpec& spec,
           const OIIO::TypeDesc& type, const std::vector<std::uint8_t>& pixels) {
  OIIO::Filesystem::IOVecOutput memory;
  const std::unique_ptr<OIIO::ImageOutput> output =
      OIIO::ImageOutput::create(target.string(), &memory);
  const bool encoded = output && output->open(target.string(), spec) &&
                       output->write_image(type, pixels.data()) && output->close();
  if (!encoded) {
    const std::string why = output ? output->geterror() : OIIO::geterror();
    throw InputError(fmt::format(
        "cannot write the picture '{}': {}; choose another place or format", target.string(), why));
  }
  const std::vector<unsigned char>& bytes = memory.buffer();
  write_file(target, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

}  // namespace

ImageFormat image_format(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  if (ending == ".png") return ImageFormat::kPng;
  if (ending == ".exr") return ImageFormat::kExr;
  throw InputError(fmt::format(
      "the picture '{}' has no ending that names a known format; let it end in .png (8-bit sRGB) "
      "or .exr (float, with depth and ids)",
      file.string()));
}

void write_image(const std::filesystem::path& file, const Image& image,
                 std::span<const DataChannel> data) {
  const ImageFormat format = image_format(file);
  require_complete(image, data);
  if (format == ImageFormat::kPng) {
    OIIO::ImageSpec spec(image.width(), image.height(), 3, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    write(file, spec, OIIO::TypeDesc::UINT8, png_pixels(image));
  } else {
    // TypeUnknown: the values are in the channels' own types already.
    write(file, exr_spec(image, data), OIIO::TypeUnknown, exr_pixels(image, data));
  }
}

}  // namespace beambench::render
