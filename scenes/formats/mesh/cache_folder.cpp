#include "scenes/formats/mesh/cache_folder.hpp"

#include <cstdlib>

namespace beambench::scenes::mesh {
namespace {

/// An environment variable that names a place; one that is empty counts as not set.
std::optional<std::filesystem::path> place(const char* variable) {
  const char* value = std::getenv(variable);
  if (value == nullptr || *value == '\0') return std::nullopt;
  return value;
}

}  // namespace

std::optional<std::filesystem::path> cache_folder() {
  if (const auto own = place("BEAMBENCH_CACHE")) return own;
  if (const auto user = place("XDG_CACHE_HOME")) return *user / "beambench";
  if (const auto home = place("HOME")) return *home / ".cache" / "beambench";
  return std::nullopt;
}

}  // namespace beambench::scenes::mesh
