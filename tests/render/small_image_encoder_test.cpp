// The small encoder of packages: OpenImageIO reads what libpng and tinyexr wrote, value by value.

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include "harness/render/picture/image_encoder.hpp"
#include "tests/temporary_folder.hpp"

namespace beambench::render {

extern "C" void beambench_encode_image(const std::string& file, const StoredImage& image,
                                       EncodedImage& encoded);

namespace {

/// Encodes an image, writes it, and opens the file with OpenImageIO.
std::unique_ptr<OIIO::ImageInput> written(const TemporaryFolder& folder, const std::string& name,
                                          const StoredImage& image) {
  EncodedImage encoded;
  beambench_encode_image(name, image, encoded);
  EXPECT_EQ(encoded.error, "");
  const auto file = folder.write(name, {encoded.bytes.begin(), encoded.bytes.end()});
  return OIIO::ImageInput::open(file.string());
}

TEST(SmallEncoder, WritesTheBytesOfAPng) {
  const TemporaryFolder folder;
  StoredImage image{5, 3, {}, {}};
  for (const char* name : {"R", "G", "B"}) image.channels.push_back({name, StoredType::kByte});
  for (std::uint8_t i = 0; i < 5 * 3 * 3; ++i)
    image.bytes.push_back(static_cast<std::uint8_t>(5 * i));
  const auto input = written(folder, "a.png", image);
  ASSERT_TRUE(input);
  EXPECT_EQ(input->spec().format, OIIO::TypeDesc::UINT8);
  EXPECT_EQ(input->spec().nchannels, 3);
  std::vector<std::uint8_t> bytes(image.bytes.size());
  ASSERT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, bytes.data()));
  EXPECT_EQ(bytes, image.bytes);
}

TEST(SmallEncoder, WritesEveryChannelOfAnExrExactly) {
  constexpr int kWidth = 40;
  constexpr int kHeight = 37;  // not a multiple of the rows that are compressed together
  const TemporaryFolder folder;
  StoredImage image{kWidth, kHeight, {}, {}};
  for (const char* name : {"R", "G", "B", "Z"})
    image.channels.push_back({name, StoredType::kFloat});
  image.channels.push_back({"id", StoredType::kUint32});
  std::vector<std::vector<std::uint32_t>> expected(image.channels.size());
  for (std::uint32_t pixel = 0; pixel < kWidth * kHeight; ++pixel) {
    const auto x = static_cast<float>(pixel);
    const float depth = pixel % 3 == 0 ? std::numeric_limits<float>::infinity() : x;
    const std::array values{std::bit_cast<std::uint32_t>(x / 7.0F),
                            std::bit_cast<std::uint32_t>(-x),
                            std::bit_cast<std::uint32_t>(1e-6F * x),
                            std::bit_cast<std::uint32_t>(depth), 0xFFFFFFFFU - pixel};
    for (std::size_t channel = 0; channel < values.size(); ++channel) {
      expected[channel].push_back(values[channel]);
      const auto bytes = std::bit_cast<std::array<std::uint8_t, 4>>(values[channel]);
      image.bytes.insert(image.bytes.end(), bytes.begin(), bytes.end());
    }
  }
  const auto input = written(folder, "a.exr", image);
  ASSERT_TRUE(input);
  for (std::size_t i = 0; i < image.channels.size(); ++i) {
    const int channel = input->spec().channelindex(image.channels[i].name);
    ASSERT_GE(channel, 0) << image.channels[i].name;
    const OIIO::TypeDesc type = i == 4 ? OIIO::TypeDesc::UINT32 : OIIO::TypeDesc::FLOAT;
    EXPECT_EQ(input->spec().channelformat(channel), type);
    std::vector<std::uint32_t> values(expected[i].size());
    ASSERT_TRUE(input->read_image(0, 0, channel, channel + 1, type, values.data()));
    EXPECT_EQ(values, expected[i]) << image.channels[i].name;
  }
}

}  // namespace
}  // namespace beambench::render
