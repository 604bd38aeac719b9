#pragma once
// The awkward scenes of the self-test as files, for programs that are not linked with beambench.

#include <filesystem>
#include <string>
#include <vector>

#include "harness/base/progress.hpp"
#include "harness/rays/ray_kind.hpp"
#include "harness/verify/selftest/selftest.hpp"
#include "harness/verify/selftest/subject.hpp"

namespace beambench::verify {

/// The rays of one query over one scene, as files.
struct KitCase {
  std::string name;             ///< "flat-cones-7, closest"
  std::filesystem::path scene;  ///< .nff
  std::filesystem::path rays;   ///< .rays
  std::filesystem::path hits;   ///< expected file of the program's hits: .hits or .csv, or missing
  std::string family{};         ///< "needles"; a kit without families: the folder
  rays::Query query = rays::Query::kClosestHit;
  bool closed = false;  ///< each ray must hit (`RaySet::must_hit`), whatever its file states
};

/// Writes a kit into a folder, which is created if missing and must be empty. Each scene has a
/// folder with scene.nff, scene.obj if the scene has only triangles, closest.rays, any.rays and
/// rays.csv (the same rays as in both). kit.json lists these folders with family and tolerance;
/// README.md explains their files. The scenes are those of `for_each_kit_scene`. `progress` gets a
/// cell for each scene. Throws InputError. Returns the number of scenes.
std::size_t write_kit(const std::filesystem::path& folder, const SelftestEffort& effort,
                      PrimitiveKinds kinds, base::Progress& progress);
/// Returns the number of scenes of a kit.
std::size_t kit_size(const SelftestEffort& effort, PrimitiveKinds kinds);

/// Returns the cases of a kit, with the hits in the same folder as the rays: closest.hits or
/// closest-hits.csv, any.hits or any-hits.csv. Throws InputError if the folder does not contain a
/// kit.
std::vector<KitCase> read_kit(const std::filesystem::path& folder);

}  // namespace beambench::verify
