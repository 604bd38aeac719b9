#include "harness/base/messages.hpp"

#include <algorithm>
#include <cstdio>
#include <vector>

#include <fmt/format.h>

#include "scenes/catalogue.hpp"

namespace beambench::base {

std::string counted(std::size_t number, std::string_view noun) {
  return fmt::format("{} {}{}", number, noun, number == 1 ? "" : "s");
}

int report_error(std::string_view program, std::string message, int exit_code) {
  std::ranges::replace_if(
      message, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  message.erase(message.find_last_not_of(' ') + 1);
  fmt::print(stderr, "{}: {}\n", program, message);
  return exit_code;
}

scenes::Scene open_scene(std::string_view spec, scenes::ReadOptions options) {
  std::vector<std::string> warnings;
  scenes::Scene scene = scenes::load_scene(spec, &warnings, options);
  for (const std::string& warning : warnings) report_error("beambench", warning, 0);
  return scene;
}

}  // namespace beambench::base
