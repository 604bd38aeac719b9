#pragma once
// The one fault of a primitive that a reader of files may pass over.

#include "scenes/core/error.hpp"

namespace beambench::scenes {

/// Thrown by `SceneBuilder` for a primitive that no ray could hit although its numbers are sound: a
/// sphere of radius 0, a cone whose radii are both 0 or that has no length, a polygon with fewer
/// than three distinct corners or without area. The builder is as it was before; a reader may skip
/// the primitive.
class DegeneratePrimitive : public InputError {
 public:
  using InputError::InputError;
};

}  // namespace beambench::scenes
