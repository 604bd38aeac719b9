#pragma once
// A program that is run to answer rays.

#include <string>

#include "harness/verify/minimize.hpp"

namespace beambench::verify {

/// Runs a command of the shell for each scene and input, in which these words are replaced by the
/// paths of files in a folder of its own:
///
///     {nff}, {obj}              the scene; OBJ has none with spheres or cones
///     {rays}, {rays_csv}        the rays
///     {hits}                    where the command is to write the hits, in either format
///
/// What the command prints goes to stderr; of later runs nothing is printed. Throws InputError here
/// when the command has no {hits}, and when it is run where it fails, or writes no hits, or not as
/// many as there are rays.
Tracer program_of(const std::string& command);

}  // namespace beambench::verify
