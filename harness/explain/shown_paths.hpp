#pragma once
// The traversal paths of all rays of an image, in tables for a page.

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
  std::string word;  ///< the family's: "leaf"
  std::uint64_t index = 0;
  bool has_box = false;
  accel::Cell cell;  ///< level 0 where there are no levels
};

/// The paths of rays, ray by ray. Step i of a ray is in `place`, `enter` and `exit` at
/// first_step[ray] + i; its tests are at first_test[step] in the tables of tests.
struct PathTable {
  std::vector<Place> places;  ///< distinct

  std::vector<std::uint32_t> first_step{0};  ///< of each ray, and the end
  std::vector<std::uint32_t> place;          ///< of each step
  std::vector<float> enter, exit;            ///< t; the exit may be the largest float
  std::vector<std::uint32_t> first_test{0};  ///< of each step, and the end
  std::vector<std::uint32_t> omitted;        ///< tests of each step that are not in the table
  std::vector<std::uint32_t> primitive;      ///< of each test
  std::vector<float> t;                      ///< of each test; kMiss (canonical_ray.hpp) for a miss

  /// Leaves that a ray passes in a beam, with all rays of that beam, before its own steps. Leaf i
  /// of a ray is at first_beam[ray] + i.
  std::vector<std::uint32_t> first_beam{0};  ///< of each ray, and the end
  std::vector<std::uint32_t> beam;           ///< of each leaf: a beam of the image
  std::vector<std::uint32_t> beam_place;     ///< the leaf
};

/// The most tests of a step in the table.
inline constexpr std::size_t kMostTests = 40;

/// Follows the first sample of each pixel. `beams` are those of the image (`Inspector::beams`), or
/// none: a ray's own steps begin where its last beam ends. `advance` is called now and then with
/// the share that is done.
PathTable follow_image(const accel::Accelerator& structure, const accel::PrimaryRays& image,
                       std::span<const accel::BeamOutline> beams,
                       const std::function<void(double)>& advance);

}  // namespace beambench::explain
