#pragma once
// Pictures as files, through OpenImageIO (see image_encoder.hpp).

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "harness/render/picture/image.hpp"

namespace beambench::render {

/// The supported formats.
enum class ImageFormat {
  kPng,  ///< 8 bits of sRGB for each of R, G, B; no data channels
  kExr   ///< linear float R, G, B, and unchanged data channels
};

/// Returns the format given by the file's extension. Throws InputError unless that is .png or .exr.
ImageFormat image_format(const std::filesystem::path& file);

/// One number for each pixel in addition to its color: depth, ids, counters.
struct DataChannel {
  std::string name;
  std::variant<std::vector<float>, std::vector<std::uint32_t>> values;
};

/// Writes the file completely or not at all. Throws InputError if it cannot be written or
/// OpenImageIO cannot be loaded, and std::logic_error if a channel does not have one value for each
/// pixel.
void write_image(const std::filesystem::path& file, const Image& image,
                 std::span<const DataChannel> data = {});

}  // namespace beambench::render
