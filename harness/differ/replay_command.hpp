#pragma once
// The command line that shows a ray's way again.

#include <string>
#include <string_view>

#include "accel/primary_rays.hpp"
#include "accel/registry.hpp"
#include "scenes/scene.hpp"

namespace beambench {

/// A word as a shell must be given it: as it is where that is safe, otherwise in single quotes.
std::string shell_quoted(std::string_view word);

/// `beambench trace SCENE --accel A --pixel X,Y ...` for the rays of an image, to be pasted into a
/// shell. Scenes from files are named by their path as it was typed.
class ReplayCommand {
 public:
  ReplayCommand(const Scene& scene, std::string_view camera, const StructureChoice& structure,
                const PrimaryRays& rays);

  std::string of(int x, int y, int sample) const;

 private:
  std::string question_;  ///< scene and structure
  std::string image_;     ///< resolution, samples, camera
  bool sampled_;          ///< more than one sample a pixel
};

}  // namespace beambench
