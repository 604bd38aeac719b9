#pragma once
// Numbers of things in sentences.

#include <cstddef>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace beambench::base {

/// "1 cell", "2 cells": the noun is given in the singular and takes an s in the plural.
inline std::string counted(std::size_t number, std::string_view noun) {
  return fmt::format("{} {}{}", number, noun, number == 1 ? "" : "s");
}

}  // namespace beambench::base
