#pragma once
// The interface of libbeambench_image_encoder.so: pixels in, the bytes of a file out, by
// OpenImageIO.
//
// It is apart from the program and loaded when a first picture is written, because OpenImageIO
// brings over two hundred shared libraries: loaded at the start, they took most of the time of
// every command that writes no picture.

#include <cstdint>
#include <string>
#include <vector>

namespace beambench::render {

/// How one channel of a pixel is stored.
enum class StoredType : std::uint8_t { kByte, kFloat, kUint32 };

/// One channel of a stored image.
struct StoredChannel {
  std::string name;
  StoredType type = StoredType::kFloat;
};

/// Pixels as the file is to hold them.
struct StoredImage {
  int width = 0;
  int height = 0;
  std::vector<StoredChannel> channels;  ///< bytes are sRGB; not mixed with other types
  std::vector<std::uint8_t> bytes;      ///< row by row; a pixel's channels are together
};

/// What became of an image: the bytes of the file, or why there are none.
struct EncodedImage {
  std::vector<unsigned char> bytes;  ///< none: it could not be encoded
  std::string error;                 ///< why, where OpenImageIO states it
};

/// Encodes the image in the format that the ending of `file` names, which is not written.
using EncodeImage = void(const std::string& file, const StoredImage& image, EncodedImage& encoded);

/// The function's name in the shared object.
inline constexpr const char* kEncodeImage = "beambench_encode_image";

/// The function, with the shared object loaded at the first call: from the folder of the program
/// (or of the Python module) that this code is part of, or from ../lib/beambench beside it. Throws
/// InputError where it is in neither or cannot be loaded.
EncodeImage& image_encoder();

}  // namespace beambench::render
