#pragma once
// The common part of structures that trace only images.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "accel/core/accelerator.hpp"
#include "accel/core/support.hpp"

namespace beambench::accel {

/// A structure registered without single rays and batches. The results of any-hit queries are
/// derived from closest hits.
class ImageAccelerator : public Accelerator {
 public:
  void any_hits(const RaySource& rays, std::span<std::uint8_t> hits,
                const QueryContext& context) const final {
    const PrimaryRays& image = image_of(rays);
    HitBuffer closest(image.width(), image.height(), image.samples());
    closest_hits(rays, closest, context);
    for (std::size_t i = 0; i < closest.size(); ++i) hits[i] = closest.get(i) ? 1 : 0;
  }

 protected:
  /// `name` is the structure's name in errors; it must outlive the structure.
  explicit ImageAccelerator(const char* name) : name_(name) {}

  /// Returns the image of a query. Throws UnsupportedError if the query is not of an image.
  const PrimaryRays& image_of(const RaySource& rays) const {
    if (const PrimaryRays* image = rays.image()) return *image;
    throw UnsupportedError("'" + std::string(name_) +
                           "' traces images only: neither single rays nor lists of rays");
  }

 private:
  const char* name_;
};

}  // namespace beambench::accel
