#include "harness/rays/resolution.hpp"

#include <charconv>
#include <cstdint>
#include <optional>

#include <fmt/format.h>

#include "scenes/core/error.hpp"

namespace beambench::rays {
namespace {

constexpr std::int64_t kMaxRays = std::int64_t{1} << 28;

/// The whole text as a side of an image.
std::optional<int> parse_side(std::string_view text) {
  int value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  if (value < 1 || value > Resolution::kMaxSide) return std::nullopt;
  return value;
}

}  // namespace

Resolution parse_resolution(std::string_view text) {
  const std::size_t cross = text.find('x');
  if (cross != std::string_view::npos) {
    const std::optional<int> width = parse_side(text.substr(0, cross));
    const std::optional<int> height = parse_side(text.substr(cross + 1));
    if (width && height) return {*width, *height};
  }
  throw InputError(fmt::format(
      "resolution '{}' is not WIDTHxHEIGHT with whole numbers from 1 to {}; write it as 640x480",
      text, Resolution::kMaxSide));
}

std::string to_string(const Resolution& resolution) {
  return fmt::format("{}x{}", resolution.width, resolution.height);
}

void require_ray_count(const Resolution& resolution, int samples) {
  const std::int64_t rays =
      std::int64_t{resolution.width} * std::int64_t{resolution.height} * std::int64_t{samples};
  if (rays <= kMaxRays) return;
  throw InputError(fmt::format(
      "{} pixels with {} samples each are {} rays, more than the {} that an image may have; lower "
      "the resolution or the samples",
      to_string(resolution), samples, rays, kMaxRays));
}

}  // namespace beambench::rays
