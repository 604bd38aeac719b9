#pragma once
// The awkward scenes of the self-test as files, for programs that link nothing of ours.

#include <filesystem>
#include <string>
#include <vector>

#include "harness/base/progress.hpp"
#include "harness/verify/selftest/selftest.hpp"
#include "harness/verify/selftest/subject.hpp"

namespace beambench::verify {

/// Rays of one query over one scene, by their files.
struct KitCase {
  std::string name;             ///< "flat-cones-7, closest"
  std::filesystem::path scene;  ///< .nff
  std::filesystem::path rays;   ///< .rays
  std::filesystem::path hits;  ///< where the program's hits are expected: .hits or .csv, or missing
};

/// Writes a kit into a folder, which is made and must be empty: for each scene a folder with
/// scene.nff, scene.obj if it has triangles alone, closest.rays, any.rays and rays.csv (the rays of
/// both); kit.json names them, README.md explains them. The scenes are the families of
/// `family_scene` and random scenes, `effort.scenes` of each, cubes on a lattice, a block of
/// squares, a heap and the smallest scenes; the rays an image's and those of the self-test, without
/// those in the plane of a polygon. `progress` gets a cell for each scene. Throws InputError.
/// Returns the number of scenes.
std::size_t write_kit(const std::filesystem::path& folder, const SelftestEffort& effort,
                      PrimitiveKinds kinds, base::Progress& progress);
/// How many scenes that are.
std::size_t kit_size(const SelftestEffort& effort, PrimitiveKinds kinds);

/// The cases of a kit, with the hits that lie beside the rays: closest.hits or closest-hits.csv,
/// any.hits or any-hits.csv. Throws InputError where the folder holds no kit.
std::vector<KitCase> read_kit(const std::filesystem::path& folder);

}  // namespace beambench::verify
