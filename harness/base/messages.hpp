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
  kNotRun = 127,      ///< as shells report it
  kInterrupted = 130  ///< as shells report it
};

/// Returns "1 cell", "2 cells": `noun` is singular, and its plural adds an s.
std::string counted(std::size_t number, std::string_view noun);

/// Formats lines with equal numbers of cells as columns of equal width, two blanks apart: the first
/// `left_columns` flush left, the others flush right. No line ends in blanks.
std::vector<std::string> aligned(std::span<const std::vector<std::string>> lines,
                                 std::size_t left_columns);

/// Returns the index of `name` in `names`. Throws InputError listing all names of this kind,
/// `what`.
std::size_t place_of_name(std::string_view what, std::string_view name,
                          std::span<const std::string_view> names);

/// Writes text to a stream for messages (stderr) and flushes it. Ignores failures, such as a full
/// disk: a result is worth more than the messages about it.
void print_message(std::FILE* stream, std::string_view text);

/// Prints `program: message` on stderr as one printable line (`message_line`), and returns
/// `exit_code`.
int report_error(std::string_view program, std::string_view message, int exit_code);

/// Prints an exception that nothing else has handled: out of memory, for which it returns
/// `kInvalidInput`, or an internal error.
int report_failure(std::string_view program, const std::exception& error);

/// Loads a scene. Prints the reader's warnings on stderr or, if the options are strict, throws
/// them. Throws what `scenes::load_scene` throws.
scenes::Scene open_scene(std::string_view spec, scenes::ReadOptions options = {});
/// Loads a scene as it is in a frame. Also throws what `scenes::show_frame` throws.
scenes::Scene open_scene(std::string_view spec, std::uint32_t frame,
                         scenes::ReadOptions options = {});
/// Loads a scene with its frames.
scenes::Animation open_animation(std::string_view spec, scenes::ReadOptions options = {});

}  // namespace beambench::base
