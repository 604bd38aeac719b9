#pragma once
// A folder that gets a picture for each of many things.

#include <filesystem>
#include <string>

namespace beambench::cli {

/// Makes it, and the folders that it is in. Throws InputError that names --pictures.
void make_picture_folder(const std::filesystem::path& folder);

/// `tetra-n-4-default-samet-max_level-5.png` of `tetra:n=4-default-samet:max_level=5`: what file
/// systems and shells take.
std::string picture_name(std::string title);

}  // namespace beambench::cli
