#pragma once
// The size of an image as it is typed: 640x480.

#include <string>
#include <string_view>

namespace beambench::rays {

/// Width and height in pixels, each in 1 ... kMaxSide.
struct Resolution {
  static constexpr int kMaxSide = 16384;

  int width;
  int height;

  friend bool operator==(const Resolution&, const Resolution&) = default;
};

/// Throws InputError when the text is not `WxH` with whole numbers in 1 ... kMaxSide.
Resolution parse_resolution(std::string_view text);

/// `640x480`.
std::string to_string(const Resolution& resolution);

/// Throws InputError when the image has more samples than a buffer is meant for (2^28), naming
/// what to lower.
void require_ray_count(const Resolution& resolution, int samples);

}  // namespace beambench::rays
