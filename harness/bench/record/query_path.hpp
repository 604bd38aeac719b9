#pragma once
// The ways by which structures are asked. The harness has another share in each.

#include <array>
#include <cstddef>
#include <string_view>

#include "accel/core/statistics.hpp"

namespace beambench::bench {

enum class QueryPath {
  kImageSingle,  ///< an image, its rays made one by one
  kImageSimd,    ///< an image, its rays made and its hits stored by SIMD
  kImageOwn,     ///< an image, by the structure's own samples: no share is the harness's
  kList,         ///< a list of rays: each is read, each answer is written
  kPicture       ///< a whole picture, which is shaded
};

/// As records name them: "image-single", ...
inline constexpr std::array<std::string_view, 5> kQueryPathNames{"image-single", "image-simd",
                                                                 "image-own", "list", "picture"};

constexpr std::string_view to_string(QueryPath path) {
  return kQueryPathNames[static_cast<std::size_t>(path)];
}

/// How a structure that gets the rays of images so is asked for one.
constexpr QueryPath image_path(accel::ImageRays rays) {
  switch (rays) {
    case accel::ImageRays::kSimd:
      return QueryPath::kImageSimd;
    case accel::ImageRays::kOwn:
      return QueryPath::kImageOwn;
    case accel::ImageRays::kSingle:
      break;
  }
  return QueryPath::kImageSingle;
}

/// The harness's own share of a trace by a path: what it takes where answers cost nothing.
struct HarnessShare {
  QueryPath path;
  double ms;
};

}  // namespace beambench::bench
