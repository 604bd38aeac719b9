#pragma once
// A structure that has followed its scene from the first frame.

#include <memory>

#include "accel/core/accelerator.hpp"
#include "accel/core/forwarding_accelerator.hpp"
#include "accel/core/registry.hpp"
#include "accel/core/tree_quality.hpp"
#include "scenes/animation.hpp"

namespace beambench::accel {

/// A structure with the scene below it, which moves.
struct MovingStructure {
  const scenes::Scene* target;            ///< the scene in its present frame
  std::unique_ptr<scenes::Scene> moving;  ///< null where the scene does not move
  std::unique_ptr<Accelerator> built;
};

/// Returns a copy of a scene's first frame, to be moved; null where the scene does not move.
std::unique_ptr<scenes::Scene> copy_first_frame(const scenes::Scene& scene);

/// A structure that is built over the first frame of a scene and then updated to the frame that the
/// scene is in. Over a scene that does not move, it is updated to the same coordinates.
class MovedStructure : private MovingStructure, public ForwardingAccelerator, public BoxHierarchy {
 public:
  /// Builds `choice` over the first frame of a scene, which must outlive it, without the checks of
  /// `StructureChoice::build`. `moving` is that of `copy_first_frame`.
  MovedStructure(const StructureChoice& choice, const scenes::Scene& scene,
                 std::unique_ptr<scenes::Scene> moving, const Workload& workload);

  /// Gives the scene below the structure the coordinates of the present frame.
  void place();
  /// Describes the structure, if it is a hierarchy.
  void describe(TreeQuality& tree) const override;
  /// Updates the structure to them. Throws UnsupportedError where it must be built anew.
  void update();
};

}  // namespace beambench::accel
