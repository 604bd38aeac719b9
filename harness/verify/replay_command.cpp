#include "harness/verify/replay_command.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "harness/plugin/load_plugin.hpp"
#include "scenes/core/shell_word.hpp"

namespace beambench::verify {
namespace {

std::string vector_text(const glm::vec3& v) { return fmt::format("{},{},{}", v.x, v.y, v.z); }

/// What picks the camera: nothing for the first, a name, or the view itself if it is no camera of
/// the scene's.
std::string view_options(const scenes::Scene& scene, const scenes::Camera& camera) {
  if (camera.name == scene.cameras.front().name) return "";
  const bool of_scene = std::ranges::any_of(
      scene.cameras, [&](const scenes::Camera& each) { return each.name == camera.name; });
  if (of_scene) return " --camera " + shell_quoted(camera.name);
  return fmt::format(" --from {} --at {} --up {} --angle {}", vector_text(camera.from),
                     vector_text(camera.at), vector_text(camera.up), camera.angle);
}

}  // namespace

ReplayCommand::ReplayCommand(const scenes::Scene& scene, const rays::ImageOfRays& image,
                             const accel::StructureChoice& structure,
                             const rays::Question& question)
    : question_(question),
      subject_(fmt::format("{} trace {} --accel {}", plugin::program_call(),
                           shell_quoted(scene.name), shell_quoted(structure.short_label()))),
      image_(fmt::format("--resolution {}", rays::to_string(image.resolution))) {
  if (image.samples > 1) image_ += fmt::format(" --samples {}", image.samples);
  image_ += view_options(scene, image.camera);
}

std::string ReplayCommand::of(std::size_t index) const {
  const auto pixel = question_.pixel(index);
  if (!pixel) {
    return fmt::format("{} --rays {} --ray {} {}", subject_, shell_quoted(question_.label()), index,
                       image_);
  }
  const std::string which =
      question_.image()->samples() > 1 ? fmt::format(" --sample {}", pixel->sample) : "";
  return fmt::format("{} --pixel {},{} {}{}", subject_, pixel->x, pixel->y, image_, which);
}

}  // namespace beambench::verify
