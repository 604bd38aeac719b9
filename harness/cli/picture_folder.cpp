#include "harness/cli/picture_folder.hpp"

#include <cctype>
#include <system_error>

#include <fmt/format.h>

#include "scenes/core/error.hpp"

namespace beambench::cli {

void make_picture_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error) return;
  throw InputError(fmt::format("cannot make the folder '{}': {}; choose another with --pictures",
                               folder.string(), error.message()));
}

std::string picture_name(std::string title) {
  for (char& c : title) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_' && c != '.') c = '-';
  }
  return title + ".png";
}

}  // namespace beambench::cli
