#pragma once
// The rays of one query.

#include <cstddef>

#include "accel/core/primary_rays.hpp"
#include "accel/core/ray.hpp"
#include "accel/core/ray_batch.hpp"

namespace beambench::accel {

/// A view of one ray, an image or a batch, which must outlive the view, as an argument outlives a
/// call. Results are numbered from 0; the results of an image as `HitBuffer` numbers its samples.
class RaySource {
 public:
  // Implicit, so that a query accepts a ray, an image or a batch directly.
  RaySource(const Ray& ray) : ray_(&ray) {}
  RaySource(const PrimaryRays& image) : image_(&image) {}
  RaySource(const RayBatch& batch) : batch_(&batch) {}

  /// Returns the source, if it is of this type; null otherwise.
  const Ray* ray() const { return ray_; }
  const PrimaryRays* image() const { return image_; }
  const RayBatch* batch() const { return batch_; }

  /// Returns the number of rays.
  std::size_t size() const {
    if (image_ != nullptr) return image_->count();
    return batch_ != nullptr ? batch_->rays.size() : 1;
  }

  /// Calls `visit(index, ray)` for all rays in order.
  template <class Visit>
  void for_each(Visit visit) const {
    if (image_ != nullptr) return image_->for_each(0, image_->height(), visit);
    if (batch_ == nullptr) return visit(std::size_t{0}, *ray_);
    std::size_t index = 0;
    for (const Ray& ray : batch_->rays) visit(index++, ray);
  }

 private:
  const Ray* ray_ = nullptr;
  const PrimaryRays* image_ = nullptr;
  const RayBatch* batch_ = nullptr;
};

}  // namespace beambench::accel
