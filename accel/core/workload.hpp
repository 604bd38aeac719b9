#pragma once
// What a structure will be asked, as far as it is known when it is built.

#include <cstddef>

#include "scenes/scene.hpp"

namespace beambench::accel {

/// Structures that choose their own parameters (`auto`) do it for this; it changes no hit.
struct Workload {
  scenes::Camera camera;  ///< where primary rays come from, and the first of secondary ones
  std::size_t rays;       ///< how many there will be, about
  int threads = 1;        ///< that will trace an image; 0: one for each core
};

/// Where nothing is known: 640x480 rays from the scene's first camera.
inline Workload usual_workload(const scenes::Scene& scene) {
  constexpr std::size_t kUsual = 640UL * 480UL;
  return {scene.cameras.front(), kUsual, 1};
}

}  // namespace beambench::accel
