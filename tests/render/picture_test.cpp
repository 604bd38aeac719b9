// Pictures: written pictures can be read back, and heat maps explain their colors.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string_view>
#include <thread>
#include <vector>

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "harness/render/picture/color.hpp"
#include "harness/render/picture/image.hpp"
#include "harness/render/picture/image_file.hpp"
#include "harness/render/picture/legend.hpp"
#include "scenes/base/error.hpp"
#include "tests/temporary_folder.hpp"

namespace beambench::render {
namespace {

namespace fs = std::filesystem;

/// Returns a picture in which every pixel has a different color.
Image colorful(int width, int height) {
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.at(x, y) = {static_cast<float>(x) / static_cast<float>(width),
                        static_cast<float>(y) / static_cast<float>(height), 0.25F};
    }
  }
  return image;
}

/// Returns a file's channels as they are stored, each value 32 bits wide.
template <class Value>
std::vector<Value> read_channel(const fs::path& file, const std::string& name,
                                OIIO::TypeDesc type) {
  const auto input = OIIO::ImageInput::open(file.string());
  if (!input) return {};
  const OIIO::ImageSpec& spec = input->spec();
  const int channel = spec.channelindex(name);
  EXPECT_GE(channel, 0) << name << " is not in " << file;
  EXPECT_EQ(spec.channelformat(channel), type) << name;
  std::vector<Value> values(static_cast<std::size_t>(spec.width) *
                            static_cast<std::size_t>(spec.height));
  input->read_image(0, 0, channel, channel + 1, type, values.data());
  return values;
}

std::size_t files_in(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(Srgb, EncodingAndDecodingAreInverse) {
  for (int byte = 0; byte < 256; ++byte) {
    const float encoded = static_cast<float>(byte) / 255.0F;
    EXPECT_NEAR(srgb_from_linear(linear_from_srgb(encoded)), encoded, 1e-5F);
  }
}

TEST(Png, HoldsTheSrgbBytesOfEveryPixel) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "colors.png";
  const Image image = colorful(7, 5);
  write_image(file, image);

  const auto input = OIIO::ImageInput::open(file.string());
  ASSERT_TRUE(input);
  ASSERT_EQ(input->spec().width, 7);
  ASSERT_EQ(input->spec().height, 5);
  ASSERT_EQ(input->spec().nchannels, 3);
  ASSERT_EQ(input->spec().format, OIIO::TypeDesc::UINT8);
  std::vector<std::uint8_t> bytes(7 * 5 * 3);
  ASSERT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, bytes.data()));
  std::size_t next = 0;
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 7; ++x) {
      const glm::vec3 encoded = srgb_from_linear(image.at(x, y));
      EXPECT_EQ(bytes[next++], std::lround(255.0F * encoded.x));
      EXPECT_EQ(bytes[next++], std::lround(255.0F * encoded.y));
      EXPECT_EQ(bytes[next++], std::lround(255.0F * encoded.z));
    }
  }
}

TEST(Exposure, ScalesLinearLight) {
  Image image(2, 1);
  image.at(0, 0) = {0.25F, 8.0F, 0.0F};
  image.at(1, 0) = {1.0F, 0.5F, 3.0F};
  expose(image, -2.0);
  EXPECT_EQ(image.at(0, 0), glm::vec3(0.0625F, 2.0F, 0.0F));
  EXPECT_EQ(image.at(1, 0), glm::vec3(0.25F, 0.125F, 0.75F));
}

TEST(Exposure, OfAnOverexposedPictureIsFound) {
  Image image(20, 10, glm::vec3(0.5F));
  EXPECT_EQ(overexposure(image).share, 0.0);
  EXPECT_EQ(overexposure(image).remedy, 0.0);
  for (int x = 0; x < 20; ++x) image.at(x, 0) = {0.0F, 0.1F, 5.0F};
  image.at(0, 0) = image.at(1, 0) = glm::vec3(1e6F);  // one of a hundred may stay too bright
  const Overexposure found = overexposure(image);
  EXPECT_DOUBLE_EQ(found.share, 0.1);
  EXPECT_NEAR(found.remedy, -2.4, 1e-9);  // log2(5) is 2.32
  expose(image, found.remedy);
  EXPECT_DOUBLE_EQ(overexposure(image).share, 0.01);
  EXPECT_EQ(overexposure(image).remedy, 0.0);
}

TEST(ImageFile, HasTheSameBytesAtAnyTime) {
  const TemporaryFolder folder;
  Image image(3, 2);
  image.at(1, 1) = {0.25F, 0.5F, 2.0F};
  const DataChannel depth{"Z", std::vector<float>(6, 1.5F)};
  for (const char* ending : {"png", "exr"}) {
    const bool has_data = std::string_view(ending) == "exr";
    const std::span<const DataChannel> data(&depth, has_data ? 1 : 0);
    const fs::path first = folder.path() / ("first." + std::string(ending));
    const fs::path second = folder.path() / ("second." + std::string(ending));
    write_image(first, image, data);
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // times are in whole seconds
    write_image(second, image, data);
    EXPECT_EQ(read_text(first), read_text(second)) << ending;
  }
}

TEST(Exr, HoldsLinearColorsDepthsAndIdsExactly) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "hits.exr";
  Image image(2, 1);
  image.at(0, 0) = {0.1F, 2.5F, 0.0F};  // values beyond 1 are kept
  image.at(1, 0) = {1e-6F, 0.5F, 1.0F};
  const std::vector<float> depths{0.1F, INFINITY};
  const std::vector<std::uint32_t> ids{16777217U, 0xFFFFFFFFU};  // not representable in float
  write_image(file, image, std::vector<DataChannel>{{"Z", depths}, {"id", ids}});

  EXPECT_EQ(read_channel<float>(file, "R", OIIO::TypeDesc::FLOAT),
            (std::vector<float>{0.1F, 1e-6F}));
  EXPECT_EQ(read_channel<float>(file, "G", OIIO::TypeDesc::FLOAT),
            (std::vector<float>{2.5F, 0.5F}));
  EXPECT_EQ(read_channel<float>(file, "B", OIIO::TypeDesc::FLOAT),
            (std::vector<float>{0.0F, 1.0F}));
  EXPECT_EQ(read_channel<float>(file, "Z", OIIO::TypeDesc::FLOAT), depths);
  EXPECT_EQ(read_channel<std::uint32_t>(file, "id", OIIO::TypeDesc::UINT32), ids);
}

TEST(ImageFile, ReplacesAnOlderPictureAndLeavesNothingBeside) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "picture.png";
  write_image(file, Image(2, 2));
  write_image(file, Image(9, 3));
  EXPECT_EQ(OIIO::ImageInput::open(file.string())->spec().width, 9);
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(ImageFile, AFailedWriteLeavesTheOlderPictureUnchanged) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "picture.exr";
  write_image(file, Image(2, 2));
  const std::vector<DataChannel> incomplete{{"Z", std::vector<float>{1.0F}}};
  EXPECT_THROW(write_image(file, Image(9, 3), incomplete), std::logic_error);
  EXPECT_THROW(write_image(folder.path() / "missing" / "a.png", Image(2, 2)), InputError);
  EXPECT_EQ(OIIO::ImageInput::open(file.string())->spec().width, 2);
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(ImageFile, RefusesAnEndingThatNamesNoFormat) {
  for (const char* name : {"a.jpg", "a", "a.PNG.txt", ".png"}) {
    EXPECT_THROW(image_format(name), InputError) << name;
  }
}

TEST(HeatColor, GetsLighterWithEveryStepAndStaysInsideSrgb) {
  const auto luminance = [](const glm::vec3& c) {
    return 0.2126F * c.x + 0.7152F * c.y + 0.0722F * c.z;
  };
  for (int i = 0; i < 1000; ++i) {
    const glm::vec3 color = heat_color(static_cast<float>(i) / 1000.0F);
    EXPECT_GT(luminance(heat_color(static_cast<float>(i + 1) / 1000.0F)), luminance(color)) << i;
    // A color outside sRGB would have been clipped at 0.
    EXPECT_GT(std::min({color.x, color.y, color.z}), 0.0F) << i;
    EXPECT_LT(std::max({color.x, color.y, color.z}), 1.0F) << i;
  }
}

TEST(HeatColor, ClampsValuesOutsideItsRange) {
  EXPECT_EQ(heat_color(-1.0F), heat_color(0.0F));
  EXPECT_EQ(heat_color(2.0F), heat_color(1.0F));
}

TEST(HeatMap, ColorsRunFromZeroToTheBrightestValue) {
  const HeatMap map{"tests", 2, 1, {0.0F, 8.0F}};
  const Image image = draw_heat_map(map);
  EXPECT_EQ(image.at(0, 0), heat_color(0.0F));
  EXPECT_EQ(image.at(1, 0), heat_color(1.0F));
}

TEST(HeatMap, OneOutlierDoesNotDarkenTheOthers) {
  HeatMap map{"tests", 1000, 1, std::vector<float>(1000, 10.0F)};
  map.values[500] = 1e6F;
  EXPECT_EQ(brightest_value(map), 10.0F);
  EXPECT_EQ(draw_heat_map(map).at(0, 0), heat_color(1.0F));
}

TEST(HeatMap, ARareValueIsVisibleIfAllOthersAreZero) {
  HeatMap map{"tests", 1000, 1, std::vector<float>(1000, 0.0F)};
  map.values[500] = 7.0F;
  EXPECT_EQ(brightest_value(map), 7.0F);
  EXPECT_EQ(draw_heat_map(map).at(500, 0), heat_color(1.0F));
}

TEST(HeatMap, TheLegendShowsTheWholeRangeOfColorsBelowTheUnchangedPicture) {
  HeatMap map{"tests", 600, 10, std::vector<float>(6000, 3.0F)};
  map.values[0] = 0.0F;
  const Image plain = draw_heat_map(map);
  const Image image = draw_heat_map_with_legend(map);
  ASSERT_EQ(image.width(), 600);
  ASSERT_GT(image.height(), 10);
  for (int x = 0; x < 600; ++x) EXPECT_EQ(image.at(x, 9), plain.at(x, 9));

  bool darkest = false;
  bool brightest = false;
  for (int y = 10; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      darkest |= image.at(x, y) == heat_color(0.0F);
      brightest |= image.at(x, y) == heat_color(1.0F);
    }
  }
  EXPECT_TRUE(darkest);
  EXPECT_TRUE(brightest);
}

TEST(HeatMap, ATinyOrEmptyPictureGetsALegendTooWideForIt) {
  const HeatMap map{"primitive_tests per ray", 1, 1, {0.0F}};
  const Image image = draw_heat_map_with_legend(map);
  EXPECT_GE(image.width(), text_width(map.title, 1));
}

RC_GTEST_PROP(LegendTicks, AreRoundNumbersWithinTheRange, ()) {
  const double maximum = *rc::gen::inRange(1, 1000000) * std::pow(10.0, *rc::gen::inRange(-6, 4));
  const int at_most = *rc::gen::inRange(2, 12);
  const std::vector<double> ticks = legend_ticks(maximum, at_most);
  RC_ASSERT(!ticks.empty());
  RC_ASSERT(ticks.front() == 0.0);
  RC_ASSERT(static_cast<int>(ticks.size()) <= at_most);
  RC_ASSERT(ticks.back() <= maximum * (1.0 + 1e-8));
  if (ticks.size() < 2) return;
  const double digit = ticks[1] / std::pow(10.0, std::floor(std::log10(ticks[1]) + 1e-9));
  RC_ASSERT(std::abs(digit - 1.0) < 1e-6 || std::abs(digit - 2.0) < 1e-6 ||
            std::abs(digit - 5.0) < 1e-6);
}

bool is_inked(const Image& image, int x) {
  for (int y = 0; y < image.height(); ++y) {
    if (image.at(x, y) == glm::vec3(1.0F)) return true;
  }
  return false;
}

TEST(Text, InksEveryGlyphAndNothingBeyondItsWidth) {
  const std::string text = "0123456789abcdefghijklmnopqrstuvwxyz.,:_-+=()/?";
  constexpr int kScale = 2;
  Image image(text_width(text, kScale) + 20, kGlyphHeight * kScale);
  draw_text(image, 0, 0, text, kScale, glm::vec3(1.0F));
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int left = static_cast<int>(i) * kGlyphAdvance * kScale;
    bool inked = false;
    for (int x = left; x < left + 5 * kScale; ++x) inked |= is_inked(image, x);
    EXPECT_TRUE(inked) << text[i];
    EXPECT_FALSE(is_inked(image, left + 5 * kScale)) << "no gap behind " << text[i];
  }
  for (int x = text_width(text, kScale); x < image.width(); ++x) EXPECT_FALSE(is_inked(image, x));
}

TEST(Text, IsCutOffAtTheEdgesOfThePicture) {
  Image image(5, 5);
  draw_text(image, -7, -3, "888", 2, glm::vec3(1.0F));
  EXPECT_TRUE(is_inked(image, 0));
}

TEST(CategoryMap, ColorsItsPixelsAndDimsTheOthersToGray) {
  const Image ground = colorful(120, 40);
  CategoryMap map{"a against b", {{"many", {1.0F, 0.0F, 0.0F}}, {"few", {0.0F, 0.0F, 1.0F}}}, {}};
  map.pixels.assign(120 * 40, CategoryMap::kNone);
  for (std::size_t i = 0; i < 120; ++i) map.pixels[i] = 0;  // the first row
  map.pixels[20 * 120 + 60] = 1;

  const Image picture = draw_category_map(map, ground);
  ASSERT_EQ(picture.width(), 120);
  EXPECT_GT(picture.height(), 40 + 2 * kGlyphHeight);
  EXPECT_EQ(picture.at(50, 0), map.categories[0].color);
  EXPECT_EQ(picture.at(60, 20), map.categories[1].color);
  EXPECT_EQ(picture.at(65, 20), map.categories[1].color)
      << "the frame of a pixel that is hard to find";
  EXPECT_NE(picture.at(50, 5), map.categories[0].color)
      << "no frames in a category with many pixels";
  const glm::vec3 gray = picture.at(10, 30);
  EXPECT_EQ(gray.x, gray.y);
  EXPECT_EQ(gray.y, gray.z);
  EXPECT_GT(gray.x, 0.0F);
}

TEST(CategoryMap, IsWidenedForItsLegend) {
  const CategoryMap map{"title", {{"a category with a long name", {1.0F, 0.0F, 0.0F}}}, {0, 0}};
  const Image picture = draw_category_map(map, Image(2, 1));
  EXPECT_GT(picture.width(), 100);
  EXPECT_EQ(picture.at(picture.width() / 2 - 1, 0), map.categories[0].color);
}

}  // namespace
}  // namespace beambench::render
