#include "harness/differ/replay_command.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

namespace beambench {
namespace {

bool is_plain(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
         std::string_view("_-+.,:=/@%").find(c) != std::string_view::npos;
}

}  // namespace

std::string shell_quoted(std::string_view word) {
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return std::string(word);
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + '\'';
}

ReplayCommand::ReplayCommand(const Scene& scene, const ImageOfRays& image,
                             const StructureChoice& structure, const Question& question)
    : question_(question),
      subject_(fmt::format("beambench trace {} --accel {}", shell_quoted(scene.name),
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
