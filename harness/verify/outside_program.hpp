#pragma once
// Runs an outside program that traces rays.

#include <stdexcept>
#include <string>

#include "harness/verify/minimize.hpp"

namespace beambench::verify {

/// Thrown when the user interrupts (Ctrl-C) a program that is running on behalf of this one.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Returns a tracer that runs a shell command for each scene and input. In the command, these words
/// are replaced by the paths of files in a temporary folder:
///
///     {nff}, {obj}              the scene; OBJ cannot express spheres or cones
///     {rays}, {rays_csv}        the rays
///     {hits}                    where the command must write the hits, in either format
///
/// The output of the first run goes to stderr; that of later runs is suppressed. Throws InputError
/// if the command has no {hits}. A run throws InputError with the command as it was run if the
/// command fails, or if the numbers of hits and rays differ; the files of the first such run are
/// kept. A run throws UnsupportedError if the command ends with exit code 77, or if {obj} cannot
/// express the scene.
Tracer program_of(const std::string& command);

}  // namespace beambench::verify
