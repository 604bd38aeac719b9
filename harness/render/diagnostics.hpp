#pragma once
// Pictures of what a structure does: where its hits differ from others, its work.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "accel/core/registry.hpp"
#include "harness/base/progress.hpp"
#include "harness/render/picture/legend.hpp"
#include "harness/verify/differ.hpp"

namespace beambench::render {

/// The names of the compared.
struct ComparedNames {
  std::string verified;   ///< whose errors are `DiffClass::kStructureError`
  std::string reference;  ///< whose errors are `DiffClass::kEmbreeError`
};

/// `kOracleName` as a reference stands for the oracle itself.
inline constexpr const char* kOracleName = "oracle";

/// Writes the classes of the rays of an image (the input's rays are primary) over a gray preview
/// of the reference; a pixel shows the worst class of its samples. A .png gets a
/// legend; an .exr the preview in colors and the classes as numbers (0 agree, 1 tie, 2 graze, 3
/// the verified structure is wrong, 4 the reference is).
void write_difference(const std::filesystem::path& file, const verify::ReferenceHits& reference,
                      std::span<const verify::DiffClass> classes, const ComparedNames& comparison);

/// A structure's hits as reference; invalid hits count as misses.
verify::ReferenceHits reference_from(const scenes::Scene& scene, const rays::TraceInput& input,
                                     const rays::TraceResults& results);

/// Traces each ray's closest hit with counters; a pixel's value is the mean of its samples. Hits go
/// to `hits`. Throws InputError listing the counters of the structure if `counter` is none of them.
HeatMap count_work(const accel::Accelerator& accelerator, const accel::PrimaryRays& rays,
                   const std::string& counter, accel::HitBuffer& hits, base::Progress& progress);

}  // namespace beambench::render
