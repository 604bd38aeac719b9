#pragma once
// The hits of an image or of a list of rays: written by structures, verified by the differ.

#include <cstddef>
#include <optional>

#include "accel/core/large_pages.hpp"
#include "accel/core/ray.hpp"

namespace beambench::accel {

/// Stores for each sample of each pixel the t of its hit and the primitive hit; a miss has t =
/// infinity and kNoPrimitive. Samples of one pixel are adjacent; pixels go row by row from the top
/// left. The hits of a list of rays are an image of one row.
class HitBuffer {
 public:
  HitBuffer(int width, int height, int samples)
      : width_(width),
        height_(height),
        samples_(samples),
        t_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
               static_cast<std::size_t>(samples),
           kInfinity),
        primitive_(t_.size(), scenes::kNoPrimitive) {}

  int width() const { return width_; }
  int height() const { return height_; }
  int samples() const { return samples_; }
  std::size_t size() const { return t_.size(); }

  std::size_t index(int x, int y, int sample) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
            static_cast<std::size_t>(x)) *
               static_cast<std::size_t>(samples_) +
           static_cast<std::size_t>(sample);
  }

  void set(std::size_t index, const std::optional<Hit>& hit) {
    t_[index] = hit ? hit->t : kInfinity;
    primitive_[index] = hit ? hit->primitive : scenes::kNoPrimitive;
  }
  std::optional<Hit> get(std::size_t index) const {
    if (primitive_[index] == scenes::kNoPrimitive) return std::nullopt;
    return Hit{t_[index], primitive_[index]};
  }

  /// Returns the raw arrays, for structures that write whole packets. They begin at a cache line,
  /// so that streaming stores can bypass the caches.
  float* t() { return t_.data(); }
  const float* t() const { return t_.data(); }
  scenes::PrimitiveId* primitive() { return primitive_.data(); }
  const scenes::PrimitiveId* primitive() const { return primitive_.data(); }

  friend bool operator==(const HitBuffer&, const HitBuffer&) = default;

 private:
  int width_;
  int height_;
  int samples_;
  LargePageVector<float> t_;
  LargePageVector<scenes::PrimitiveId> primitive_;
};

/// The destination of a query's closest hits: a view of a HitBuffer or of one hit, which must
/// outlive it.
class HitSpan {
 public:
  // Implicit, so that a query accepts the buffer itself.
  HitSpan(HitBuffer& buffer)
      : t_(buffer.t()),
        primitive_(buffer.primitive()),
        width_(buffer.width()),
        height_(buffer.height()),
        samples_(buffer.samples()) {}
  /// Views one hit; a miss has t = infinity and kNoPrimitive.
  explicit HitSpan(Hit& hit)
      : t_(&hit.t), primitive_(&hit.primitive), width_(1), height_(1), samples_(1) {}

  /// Views the hits of a list in two arrays.
  HitSpan(float* t, scenes::PrimitiveId* primitive, std::size_t count)
      : t_(t), primitive_(primitive), width_(static_cast<int>(count)), height_(1), samples_(1) {}

  /// Returns a view of the hits [first, first + count) of a list.
  HitSpan part(std::size_t first, std::size_t count) const {
    HitSpan part(*this);
    part.t_ += first;
    part.primitive_ += first;
    part.width_ = static_cast<int>(count);
    part.height_ = part.samples_ = 1;
    return part;
  }

  int width() const { return width_; }
  int height() const { return height_; }
  int samples() const { return samples_; }
  std::size_t size() const {
    return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) *
           static_cast<std::size_t>(samples_);
  }

  /// Returns the same index as `HitBuffer::index`.
  std::size_t index(int x, int y, int sample) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
            static_cast<std::size_t>(x)) *
               static_cast<std::size_t>(samples_) +
           static_cast<std::size_t>(sample);
  }
  void set(std::size_t index, const std::optional<Hit>& hit) const {
    t_[index] = hit ? hit->t : kInfinity;
    primitive_[index] = hit ? hit->primitive : scenes::kNoPrimitive;
  }
  std::optional<Hit> get(std::size_t index) const {
    if (primitive_[index] == scenes::kNoPrimitive) return std::nullopt;
    return Hit{t_[index], primitive_[index]};
  }
  /// Returns the raw arrays, for structures that write whole packets.
  float* t() const { return t_; }
  scenes::PrimitiveId* primitive() const { return primitive_; }

 private:
  float* t_;
  scenes::PrimitiveId* primitive_;
  int width_;
  int height_;
  int samples_;
};

}  // namespace beambench::accel
