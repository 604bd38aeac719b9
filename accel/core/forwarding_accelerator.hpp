#pragma once
// A wrapper around another structure.

#include <cstdint>
#include <span>

#include "accel/core/accelerator.hpp"

namespace beambench::accel {

/// Forwards everything to another structure. A wrapper overrides the functions that it changes.
class ForwardingAccelerator : public Accelerator {
 public:
  /// The structure must outlive this object.
  explicit ForwardingAccelerator(const Accelerator& structure) : structure_(&structure) {}

  void closest_hits(const RaySource& rays, const HitSpan& hits,
                    const QueryContext& context) const override {
    structure_->closest_hits(rays, hits, context);
  }
  void any_hits(const RaySource& rays, std::span<std::uint8_t> hits,
                const QueryContext& context) const override {
    structure_->any_hits(rays, hits, context);
  }
  Statistics statistics() const override { return structure_->statistics(); }
  const Inspector* inspector() const override { return structure_->inspector(); }

 protected:
  const Accelerator& structure() const { return *structure_; }

 private:
  const Accelerator* structure_;
};

}  // namespace beambench::accel
