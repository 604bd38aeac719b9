#pragma once
// Messages to the user, and exit codes.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/animation.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene.hpp"

namespace beambench::base {

enum ExitCode : int {
  kSuccess = 0,
  kMismatch = 1,      ///< a mismatch, an error of a structure or a regression was found
  kInvalidInput = 2,  ///< invalid arguments or input
  kInternalError = 70,
  kNotRun = 127,      ///< as reported by shells
  kInterrupted = 130  ///< as reported by shells
};

/// Returns "1 cell", "2 cells": the noun is given in the singular and gets an s in the plural.
std::string counted(std::size_t number, std::string_view noun);

/// Formats lines with equal numbers of cells as columns of equal width, two blanks apart: the first
/// `left_columns` flush left, the others flush right. No line ends in blanks.
std::vector<std::string> aligned(std::span<const std::vector<std::string>> lines,
                                 std::size_t left_columns);

/// Returns the place of a name among those of a kind, `what`. Throws InputError listing them.
std::size_t place_of_name(std::string_view what, std::string_view name,
                          std::span<const std::string_view> names);

/// Writes text to a stream of messages (stderr), at once. A failure (such as a full disk) is
/// ignored: a result is worth more than the messages about it.
void print_message(std::FILE* stream, std::string_view text);

/// Prints `program: message` on stderr as one printable line (`message_line`), and returns
/// `exit_code`.
int report_error(std::string_view program, std::string_view message, int exit_code);

/// Prints an exception that nothing else has handled: out of memory, with `kInvalidInput`, or an
/// internal error.
int report_failure(std::string_view program, const std::exception& error);

/// Loads a scene. The warnings of its reader are printed on stderr or, if the options are strict,
/// thrown. Throws as `scenes::load_scene`.
scenes::Scene open_scene(std::string_view spec, scenes::ReadOptions options = {});
/// Loads a scene as it is in a frame. Throws as `scenes::show_frame`, too.
scenes::Scene open_scene(std::string_view spec, std::uint32_t frame,
                         scenes::ReadOptions options = {});
/// Loads a scene with its frames.
scenes::Animation open_animation(std::string_view spec, scenes::ReadOptions options = {});

}  // namespace beambench::base
