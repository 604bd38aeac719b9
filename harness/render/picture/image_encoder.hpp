#pragma once
// The interface of libbeambench_image_encoder.so: it converts pixels to the bytes of a file, with
// OpenImageIO (image_encoder.cpp) or with libpng and tinyexr (small_image_encoder.cpp).
//
// It is separate from the program and loaded when the first picture is written, because OpenImageIO
// needs over two hundred shared libraries. Loading these at the start took most of the time of
// every command that does not write a picture.

#include <cstdint>
#include <string>
#include <vector>

namespace beambench::render {

/// The storage type of one channel of a pixel.
enum class StoredType : std::uint8_t { kByte, kFloat, kUint32 };

/// One channel of a stored image.
struct StoredChannel {
  std::string name;
  StoredType type = StoredType::kFloat;
};

/// Pixels in the form stored in the file.
struct StoredImage {
  int width = 0;
  int height = 0;
  std::vector<StoredChannel> channels;  ///< bytes are sRGB and are not mixed with other types
  std::vector<std::uint8_t> bytes;      ///< row by row; a pixel's channels are together
};

/// The result of encoding an image: the bytes of the file, or the reason for a failure.
struct EncodedImage {
  std::vector<unsigned char> bytes;  ///< empty if encoding failed
  std::string error;                 ///< the reason, if the library gives one
};

/// Encodes the image in the format given by the extension of `file`, which is not written.
using EncodeImage = void(const std::string& file, const StoredImage& image, EncodedImage& encoded);

/// The function's name in the shared object.
inline constexpr const char* kEncodeImage = "beambench_encode_image";

/// Returns the function, loading the shared object on the first call from the folder of the program
/// (or of the Python module) that contains this code, or from ../lib/beambench beside it. Throws
/// InputError if the shared object is in neither place or cannot be loaded.
EncodeImage& image_encoder();

}  // namespace beambench::render
