#pragma once
// The traversal paths of all rays of an image, as tables for a page.

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "accel/core/accelerator.hpp"
#include "accel/core/primary_rays.hpp"

namespace beambench::explain {

/// A cell, node or leaf that rays or beams enter.
struct Place {
  std::string word;  ///< its word in the structure's family: "leaf"
  std::uint64_t index = 0;
  bool has_box = false;
  accel::Cell cell;  ///< level 0 if there are no levels
};

/// The paths of rays, ray by ray. Step i of a ray is at index first_step[ray] + i in `place`,
/// `enter` and `exit`; its tests begin at first_test[step] in the tables of tests.
struct PathTable {
  std::vector<Place> places;  ///< without duplicates

  std::vector<std::uint32_t> first_step{0};  ///< of each ray, then the total
  std::vector<std::uint32_t> place;          ///< of each step
  std::vector<float> enter, exit;            ///< t; the exit may be the largest float
  std::vector<std::uint32_t> first_test{0};  ///< of each step, then the total
  std::vector<std::uint32_t> omitted;        ///< number of each step's tests not in the table
  std::vector<std::uint32_t> primitive;      ///< of each test
  std::vector<float> t;                      ///< of each test; kMiss (canonical_ray.hpp) for a miss

  /// Leaves that a ray passes within a beam, with all rays of that beam, before its own steps. Leaf
  /// i of a ray is at index first_beam[ray] + i.
  std::vector<std::uint32_t> first_beam{0};  ///< of each ray, then the total
  std::vector<std::uint32_t> beam;           ///< for each leaf, the index of the image's beam
  std::vector<std::uint32_t> beam_place;     ///< for each leaf, its place
};

/// The maximum number of tests of a step in the table.
inline constexpr std::size_t kMostTests = 40;

/// Follows the first sample of each pixel. `beams` are the beams of the image (`Inspector::beams`),
/// if any; a ray's own steps begin where its last beam ends. Calls `advance` from time to time with
/// the fraction done.
PathTable follow_image(const accel::Accelerator& structure, const accel::PrimaryRays& image,
                       std::span<const accel::BeamOutline> beams,
                       const std::function<void(double)>& advance);

}  // namespace beambench::explain
