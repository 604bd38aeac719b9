#pragma once
// The order in which the samples of a picture are shaded.

#include <cstddef>
#include <string_view>
#include <vector>

#include "accel/core/accelerator.hpp"

namespace beambench::render {

/// What a shadow cache remembers depends on which samples follow each other.
enum class ShadingOrder {
  kRows,  ///< row by row, the cache begins anew in each; rows may be shared among threads
  kScan,  ///< pixel by pixel along the rows, with one cache
  kBeams  ///< beam by beam, with one cache: what the thesis expects a cache to gain by (6.2.2)
};

/// `rows`, `scan`, `beams`. Throws InputError for another name.
ShadingOrder parse_shading_order(std::string_view name);

/// The places in the hit buffer of all samples along the rows.
std::vector<std::size_t> scan_order(const accel::PrimaryRays& rays);

/// The same places as beams decide them: those of a beam are together, along the rows; then those
/// that no beam at an occupied leaf had. Throws InputError for a structure that traces no beams.
std::vector<std::size_t> beam_order(const accel::Accelerator& structure,
                                    const accel::PrimaryRays& rays);

}  // namespace beambench::render
