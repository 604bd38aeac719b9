#pragma once
// The option of both cluster programs that selects how a divided scene is distributed.

#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/thesis/cluster/split/scene_division.hpp"

namespace beambench::cli {

/// Adds --division; `name` has its default. `cluster::parse_scene_division` parses the value.
inline CLI::Option* add_division_option(CLI::App& app, std::string& name) {
  return app
      .add_option("--division", name,
                  fmt::format("How the cells of --split are distributed: {}",
                              fmt::join(cluster::division_names(), ", ")))
      ->capture_default_str();
}

}  // namespace beambench::cli
