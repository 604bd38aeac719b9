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

ReplayCommand::ReplayCommand(const Scene& scene, std::string_view camera,
                             const StructureChoice& structure, const PrimaryRays& rays)
    : question_(fmt::format("beambench trace {} --accel {}", shell_quoted(scene.name),
                            shell_quoted(structure.short_label()))),
      image_(fmt::format("--resolution {}x{}", rays.width(), rays.height())),
      sampled_(rays.samples() > 1) {
  if (sampled_) image_ += fmt::format(" --samples {}", rays.samples());
  if (camera != scene.cameras.front().name) image_ += " --camera " + shell_quoted(camera);
}

std::string ReplayCommand::of(int x, int y, int sample) const {
  const std::string which = sampled_ ? fmt::format(" --sample {}", sample) : "";
  return fmt::format("{} --pixel {},{} {}{}", question_, x, y, image_, which);
}

}  // namespace beambench
