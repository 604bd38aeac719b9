#include "harness/render/picture/image_encoder.hpp"

#include <cstddef>
#include <memory>
#include <type_traits>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

namespace beambench::render {
namespace {

OIIO::TypeDesc type_of(StoredType type) {
  switch (type) {
    case StoredType::kByte:
      return OIIO::TypeDesc::UINT8;
    case StoredType::kFloat:
      return OIIO::TypeDesc::FLOAT;
    case StoredType::kUint32:
      break;
  }
  return OIIO::TypeDesc::UINT32;
}

OIIO::ImageSpec spec_of(const StoredImage& image) {
  const StoredType first = image.channels.front().type;
  OIIO::ImageSpec spec(image.width, image.height, static_cast<int>(image.channels.size()),
                       type_of(first));
  if (first == StoredType::kByte) {
    spec.attribute("oiio:ColorSpace", "sRGB");
    return spec;
  }
  for (std::size_t at = 0; at < image.channels.size(); ++at) {
    spec.channelnames[at] = image.channels[at].name;
    spec.channelformats.push_back(type_of(image.channels[at].type));
  }
  spec.attribute("compression", "zip");
  // Otherwise OpenImageIO records the time of writing, and equal pictures would differ.
  spec.attribute("DateTime", "1970:01:01 00:00:00");
  return spec;
}

}  // namespace

/// Encodes in memory, because OpenImageIO does not notice a full disk.
extern "C" void beambench_encode_image(const std::string& file, const StoredImage& image,
                                       EncodedImage& encoded) {
  OIIO::Filesystem::IOVecOutput memory;
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(file, &memory);
  // TypeUnknown: the values already have the channels' types.
  if (output && output->open(file, spec_of(image)) &&
      output->write_image(OIIO::TypeUnknown, image.bytes.data()) && output->close()) {
    encoded.bytes = memory.buffer();
  } else {
    encoded.error = output ? output->geterror() : OIIO::geterror();
    if (encoded.error.empty()) encoded.error = "OpenImageIO gives no reason";
  }
}
// The loader of the shared object assumes this type.
static_assert(std::is_same_v<decltype(beambench_encode_image), EncodeImage>);

}  // namespace beambench::render
