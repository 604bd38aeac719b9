#include "harness/base/messages.hpp"

#include <algorithm>
#include <cstdio>
#include <new>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/base/error.hpp"
#include "scenes/base/printable.hpp"
#include "scenes/catalogue.hpp"

namespace beambench::base {

std::string counted(std::size_t number, std::string_view noun) {
  return fmt::format("{} {}{}", number, noun, number == 1 ? "" : "s");
}

std::vector<std::string> aligned(std::span<const std::vector<std::string>> lines,
                                 std::size_t left_columns) {
  std::vector<std::size_t> widths;
  for (const auto& line : lines) {
    widths.resize(std::max(widths.size(), line.size()));
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  std::vector<std::string> out;
  for (const auto& line : lines) {
    std::string text;
    for (std::size_t i = 0; i < line.size(); ++i) {
      text += i == 0 ? "" : "  ";
      text += i < left_columns ? fmt::format("{:<{}}", line[i], widths[i])
                               : fmt::format("{:>{}}", line[i], widths[i]);
    }
    text.erase(text.find_last_not_of(' ') + 1);
    out.push_back(std::move(text));
  }
  return out;
}

std::size_t place_of_name(std::string_view what, std::string_view name,
                          std::span<const std::string_view> names) {
  const auto found = std::ranges::find(names, name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  throw InputError(
      fmt::format("unknown {} '{}'; choose from: {}", what, excerpt(name), fmt::join(names, ", ")));
}

void print_message(std::FILE* stream, std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stream);
  std::fflush(stream);
}

int report_error(std::string_view program, std::string_view message, int exit_code) {
  print_message(stderr, fmt::format("{}: {}\n", program, message_line(message)));
  return exit_code;
}

int report_failure(std::string_view program, const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) {
    return report_error(program, "out of memory; choose a smaller scene, resolution or structure",
                        kInvalidInput);
  }
  return report_error(
      program,
      fmt::format("internal error, please report it with the command line: {}", error.what()),
      kInternalError);
}

scenes::Animation open_animation(std::string_view spec, scenes::ReadOptions options) {
  std::vector<std::string> warnings;
  scenes::Animation animation = scenes::load_animation(spec, &warnings, options);
  for (const std::string& warning : warnings) report_error("beambench", warning, 0);
  return animation;
}

scenes::Scene open_scene(std::string_view spec, scenes::ReadOptions options) {
  return open_animation(spec, options).scene;
}

scenes::Scene open_scene(std::string_view spec, std::uint32_t frame, scenes::ReadOptions options) {
  scenes::Animation animation = open_animation(spec, options);
  if (frame > 0) scenes::show_frame(animation, frame);
  return std::move(animation.scene);
}

}  // namespace beambench::base
