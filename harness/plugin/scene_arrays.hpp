#pragma once
// A scene as the arrays of the C interface.

#include <vector>

#include "harness/plugin/c/beambench/contender.h"
#include "scenes/scene.hpp"

namespace beambench::plugin {

/// The vertices and triangles are those of the scene, which must outlive this object. Spheres and
/// cones are copied, because the scene stores their ids separately.
class SceneArrays {
 public:
  explicit SceneArrays(const scenes::Scene& scene);
  SceneArrays(const SceneArrays&) = delete;
  SceneArrays& operator=(const SceneArrays&) = delete;

  const beambench_scene& view() const { return view_; }

 private:
  std::vector<beambench_sphere> spheres_;
  std::vector<beambench_cone> cones_;
  beambench_scene view_;
};

}  // namespace beambench::plugin
