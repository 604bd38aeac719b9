#include "harness/differ/replay_command.hpp"

#include <fmt/format.h>

#include "harness/files/shell_word.hpp"
#include "harness/plugin/load_plugin.hpp"

namespace beambench {
ReplayCommand::ReplayCommand(const Scene& scene, const ImageOfRays& image,
                             const StructureChoice& structure, const Question& question)
    : question_(question),
      subject_(fmt::format("{} trace {} --accel {}", program_call(), shell_quoted(scene.name),
                           shell_quoted(structure.short_label()))),
      image_(fmt::format("--resolution {}", to_string(image.resolution))) {
  if (image.samples > 1) image_ += fmt::format(" --samples {}", image.samples);
  if (image.camera.name != scene.cameras.front().name) {
    image_ += " --camera " + shell_quoted(image.camera.name);
  }
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

}  // namespace beambench
