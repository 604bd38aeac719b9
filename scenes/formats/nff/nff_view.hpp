#pragma once
// The view of an NFF file: the command `v` and the lines that belong to it.

#include "scenes/camera.hpp"
#include "scenes/formats/nff/nff_tokens.hpp"

namespace beambench::scenes::nff {

/// Takes the lines after `view`, the token `v`, as far as they belong to it. The camera's name is
/// empty when the file has none. Throws InputError with file and line when something is missing.
Camera read_nff_view(NffTokens& tokens, const NffToken& view);

}  // namespace beambench::scenes::nff
