#pragma once
// A picture in memory.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace beambench::render {

/// Pixels row by row from the top left, in linear light of the sRGB primaries.
class Image {
 public:
  Image(int width, int height, const glm::vec3& fill = glm::vec3(0.0F))
      : width_(width),
        height_(height),
        pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), fill) {}

  int width() const { return width_; }
  int height() const { return height_; }
  glm::vec3& at(int x, int y) { return pixels_[index(x, y)]; }
  const glm::vec3& at(int x, int y) const { return pixels_[index(x, y)]; }
  std::span<glm::vec3> pixels() { return pixels_; }
  std::span<const glm::vec3> pixels() const { return pixels_; }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }

  int width_;
  int height_;
  std::vector<glm::vec3> pixels_;
};

/// Multiplies linear light by two to the power of `stops`, in the photographic sense.
void expose(Image& image, double stops);

struct Overexposure {
  double share = 0.0;   ///< share of pixels with a component above 1, which a display clips
  double remedy = 0.0;  ///< stops, in tenths, after which at most 1% of the pixels are clipped
};
/// Returns the overexposure. The remedy is 0 if none is needed.
Overexposure overexposure(const Image& image);

/// Returns the fingerprint of all pixels, bit for bit.
std::uint64_t fingerprint(const Image& image);

/// Returns the RMS error of a picture relative to another of its size, over pixels and channels, in
/// display values on a 0-255 scale before rounding.
double root_mean_square_error(const Image& picture, const Image& reference);

}  // namespace beambench::render
