#pragma once
// Messages to the user.

#include <cstddef>
#include <string>
#include <string_view>

#include "scenes/catalogue.hpp"
#include "scenes/scene.hpp"

namespace beambench::base {

/// "1 cell", "2 cells": the noun is given in the singular and takes an s in the plural.
std::string counted(std::size_t number, std::string_view noun);

/// Prints `program: message` on stderr as one line, and returns `exit_code`.
int report_error(std::string_view program, std::string message, int exit_code);

/// Loads a scene; the warnings of its reader are printed on stderr, or, if the options are strict,
/// thrown. Throws as `scenes::load_scene`.
scenes::Scene open_scene(std::string_view spec, scenes::ReadOptions options = {});

}  // namespace beambench::base
