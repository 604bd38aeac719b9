#pragma once
// Pictures that show how a structure's hits differ from a reference, or how much work it does.

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/registry.hpp"
#include "harness/base/progress.hpp"
#include "harness/render/picture/legend.hpp"
#include "harness/verify/differ.hpp"

namespace beambench::render {

/// The names of the compared structures.
struct ComparedNames {
  std::string verified;   ///< whose errors are `DiffClass::kStructureError`
  std::string reference;  ///< whose errors are `DiffClass::kOracleError`
};

/// The name of a reference that is the oracle itself.
inline constexpr const char* kOracleName = "oracle";

/// Writes the classes of the rays of an image (the input must have primary rays) over a gray
/// preview of the reference; a pixel shows the worst class of its samples. A .png has a legend; an
/// .exr has the preview in colors and the classes as numbers (0 agree, 1 tie, 2 graze, 3 the
/// verified structure is wrong, 4 the reference is wrong).
void write_difference(const std::filesystem::path& file, const verify::ReferenceHits& reference,
                      std::span<const verify::DiffClass> classes, const ComparedNames& comparison);

/// Collects the places of wrong, grazing or tied rays: the point of the oracle's hit, or of the
/// claimed one if the oracle finds none. Limited in memory.
class DisputedPlaces {
 public:
  void add(const verify::Mismatch& mismatch);
  bool empty() const;

  /// Returns the places of a class; at most kMaxPoints each.
  const std::vector<glm::dvec3>& of(verify::DiffClass diff_class) const {
    return points_[static_cast<std::size_t>(diff_class)];
  }

  static constexpr std::size_t kMaxPoints = 100'000;

 private:
  std::array<std::vector<glm::dvec3>, static_cast<std::size_t>(verify::DiffClass::kCount)>
      points_{};
};

/// Writes a preview of the scene with the places marked; a .png has a legend.
void write_disputed_places(const std::filesystem::path& file, const scenes::Scene& scene,
                           const accel::PrimaryRays& rays, const DisputedPlaces& places);

/// Returns a structure's hits as a reference; invalid hits count as misses.
verify::ReferenceHits reference_from(const scenes::Scene& scene, const rays::TraceInput& input,
                                     const rays::TraceResults& results);

/// Finds each ray's closest hit and counts the work; a pixel's value is the mean of its samples.
/// Writes the hits to `hits`. Throws InputError listing the structure's counters if `counter` is
/// not one of them.
HeatMap count_work(const accel::Accelerator& accelerator, const accel::PrimaryRays& rays,
                   const std::string& counter, accel::HitBuffer& hits, base::Progress& progress);

}  // namespace beambench::render
