#pragma once
// How an image is divided among consumers: parts of it, and which of them a message has.

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "accel/beam/sample_lattice.hpp"

namespace beambench::cluster {

/// What the tasks are, and how they are distributed. All but the first three are static (thesis,
/// section 2.3.2.1): each consumer receives all its work in one message.
enum class Work {
  kBeams,       ///< the producer's beams to occupied leaves, to whoever waits (thesis, chapter 6)
  kBlocks,      ///< blocks of individual rays, to whoever waits
  kTiles,       ///< blocks whose beams the consumers make, in messages that become smaller
  kContiguous,  ///< neighboring rows of individual rays (Hu and Foley 1985)
  kInterlaced,  ///< of P consumers the i-th gets the rows i, i + P, ... (Isler and Özgüç 1991)
  kWindows,     ///< the same with blocks for rows
  kPrePass      ///< blocks by their estimated costs (Salmon and Goldsmith 1988; Priol 1989)
};

/// The word for it on the command line.
std::string_view name_of(Work work);
/// Nothing for another word.
std::optional<Work> work_named(std::string_view name);
bool is_static(Work work);

/// Of an image of width x height pixels: blocks, row by row, smaller at the right and lower border.
std::vector<accel::beam::PixelRect> blocks_of(int width, int height, int block_width,
                                              int block_height);

/// In an order in which any part of the list has blocks from all over the image: by the digits of
/// their numbers reversed (van der Corput 1935).
std::vector<accel::beam::PixelRect> spread(const std::vector<accel::beam::PixelRect>& blocks);

/// The numbers of the tasks in one message.
using Share = std::vector<std::size_t>;

/// How tasks 0 ... `tasks` - 1 become messages.
enum class Division {
  kContiguous,  ///< as many shares as consumers, each of neighbors
  kInterlaced,  ///< as many shares as consumers, task i in share i modulo their number
  kEqualCost,   ///< as many shares as consumers: the costliest task left goes to the share with the
                ///< lowest cost so far (Graham 1969)
  kFalling      ///< for each consumer a message, then one of half as many tasks, down to a few:
                ///< few messages, and little work left when the tasks are used up (factoring:
                ///< Hummel, Schonberg and Flynn 1992)
};

/// In the order in which they are to be sent; no share is empty. `costs` are estimates in any unit,
/// needed for kEqualCost alone.
std::vector<Share> divide(Division division, std::size_t tasks, int consumers,
                          std::span<const double> costs);

/// How the tasks of that work are divided. Not for kBeams and kBlocks, which are not divided
/// before.
Division division_of(Work work);

}  // namespace beambench::cluster
