#include "scenes/formats/mesh/mesh_companions.hpp"

#include <algorithm>
#include <optional>
#include <system_error>

#include <fmt/format.h>

#include "scenes/base/error.hpp"
#include "scenes/formats/mesh/mesh_cache.hpp"
#include "scenes/formats/mesh/mesh_file.hpp"

namespace beambench::scenes::mesh {
namespace {

namespace fs = std::filesystem;

/// Returns whether a path lies in a folder; both must be without links and `..`.
bool lies_in(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first ==
         folder.end();
}

/// Returns the path of a companion, with links followed; nothing if it is outside the folder. The
/// path of a missing companion follows from its name.
std::optional<fs::path> place_of(const fs::path& name, const fs::path& folder) {
  if (name.is_absolute() || name.empty()) return std::nullopt;
  const fs::path said = (folder / name).lexically_normal();
  if (!lies_in(said, folder)) return std::nullopt;
  std::error_code error;
  const fs::path real = fs::weakly_canonical(folder / name, error);
  if (error) return said;
  if (!lies_in(real, folder)) return std::nullopt;
  return real;
}

[[noreturn]] void refuse_size() {
  throw InputError(
      "it and the files that it refers to hold more than 4 GiB; split it, or reduce its triangles");
}

}  // namespace

MeshCompanions::MeshCompanions(const fs::path& mesh, std::uint64_t mesh_bytes)
    : folder_(companion_folder(mesh)),
      bytes_left_(kLargestMeshFile - std::min(mesh_bytes, kLargestMeshFile)) {}

bool MeshCompanions::has(const fs::path& name) {
  const auto place = place_of(name, folder_);
  if (!place) return false;
  std::error_code ignored;
  if (fs::is_regular_file(*place, ignored)) return true;
  companions_.try_emplace(name.lexically_normal().string());
  return false;
}

std::string_view MeshCompanions::read(const fs::path& name) {
  const auto place = place_of(name, folder_);
  if (!place) {
    throw InputError(fmt::format(
        "it refers to the file '{}', which is not in its folder and is not read; put the "
        "file into the folder, and name it without '..' and links",
        name.string()));
  }
  const auto [found, is_new] = companions_.try_emplace(name.lexically_normal().string());
  Companion& companion = found->second;
  if (!is_new && !companion.bytes.empty()) return companion.bytes;
  std::error_code ignored;
  if (const auto size = fs::file_size(*place, ignored); !ignored && size > bytes_left_)
    refuse_size();
  try {
    companion.bytes = read_bytes(*place);
  } catch (const InputError& error) {
    throw InputError(fmt::format("it needs a file that is missing or unusable ({})", error.what()));
  }
  companion.hash = content_hash(companion.bytes);
  if (companion.bytes.size() > bytes_left_) refuse_size();  // it has grown
  bytes_left_ -= companion.bytes.size();
  return companion.bytes;
}

void MeshCompanions::release(const fs::path& name) {
  const auto found = companions_.find(name.lexically_normal().string());
  if (found != companions_.end()) found->second.bytes = {};
}

std::vector<MeshCompanion> MeshCompanions::list() const {
  std::vector<MeshCompanion> list;
  for (const auto& [name, companion] : companions_) list.push_back({name, companion.hash});
  return list;
}

}  // namespace beambench::scenes::mesh
