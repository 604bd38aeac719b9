#include "accel/core/hit_buffer.hpp"

namespace beambench::accel {

HitBuffer::HitBuffer(int width, int height, int samples)
    : width_(width),
      height_(height),
      samples_(samples),
      t_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
             static_cast<std::size_t>(samples),
         kInfinity),
      primitive_(t_.size(), scenes::kNoPrimitive) {}

}  // namespace beambench::accel
