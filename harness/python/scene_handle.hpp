#pragma once
// A scene shared by Python objects and long-running work.

#include <memory>
#include <string>
#include <vector>

#include "harness/rays/trace_input.hpp"
#include "scenes/camera.hpp"
#include "scenes/scene.hpp"

namespace beambench::python {

/// A scene, and the warnings from reading it.
struct SceneHandle {
  std::shared_ptr<const scenes::Scene> scene;
  std::vector<std::string> warnings{};
};

/// The camera of an image, its size (0 x 0: the camera's own) and samples per pixel.
struct ImageChoice {
  scenes::Camera camera;
  int width;
  int height;
  int samples;
};

/// Returns the image chosen. Throws InputError for an invalid camera or image.
rays::ImageOfRays image_of(const ImageChoice& choice);

}  // namespace beambench::python
