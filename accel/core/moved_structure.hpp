#pragma once
// A structure built over the first frame of its scene and then updated.

#include <memory>

#include "accel/core/accelerator.hpp"
#include "accel/core/forwarding_accelerator.hpp"
#include "accel/core/registry.hpp"
#include "accel/core/tree_quality.hpp"
#include "scenes/animation.hpp"

namespace beambench::accel {

/// A structure and the scene that it is built over.
struct MovingStructure {
  const scenes::Scene* target;            ///< the scene in its present frame
  std::unique_ptr<scenes::Scene> moving;  ///< null if the scene does not move
  std::unique_ptr<Accelerator> built;
};

/// Returns a copy of a scene's first frame, to be moved; null if the scene is static.
std::unique_ptr<scenes::Scene> copy_first_frame(const scenes::Scene& scene);

/// A structure built over the first frame of a scene and then updated to the scene's current frame.
/// For a static scene, it is updated to the same coordinates.
class MovedStructure : private MovingStructure, public ForwardingAccelerator, public BoxHierarchy {
 public:
  /// Builds `choice` over the first frame of a scene, which must outlive it, without the checks of
  /// `StructureChoice::build`. `moving` is the result of `copy_first_frame`.
  MovedStructure(const StructureChoice& choice, const scenes::Scene& scene,
                 std::unique_ptr<scenes::Scene> moving, const Workload& workload);

  /// Moves the structure's scene to the coordinates of the current frame.
  void place();
  /// Describes the nodes of the structure if it is a hierarchy.
  void describe(TreeQuality& tree) const override;
  /// Updates the structure to the coordinates of its scene. Throws UnsupportedError if it must be
  /// rebuilt.
  void update();
};

}  // namespace beambench::accel
