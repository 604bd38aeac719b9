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

/// The blocks of an image in an order in which any that follow each other come from all over the
/// image: an additive recurrence in both directions (Kronecker; its constants are Roberts's, "The
/// unreasonable effectiveness of quasirandom sequences", 2018). Known to all processes, so that a
/// range of numbers stands for its blocks.
class TileOrder {
 public:
  /// Of an image of width x height pixels, in tiles of size x size.
  TileOrder(int width, int height, int size);

  std::size_t count() const { return columns_ * rows_; }
  /// The i-th; smaller at the right and lower border.
  accel::beam::PixelRect operator[](std::size_t i) const;

 private:
  int width_;
  int height_;
  int size_;
  std::size_t columns_;
  std::size_t rows_;
  std::size_t step_;
};

/// The numbers of the tasks in one message.
using Share = std::vector<std::size_t>;

/// How tasks 0 ... `tasks` - 1 become messages.
enum class ImageDivision {
  kContiguous,  ///< as many shares as consumers, each of neighbors
  kInterlaced,  ///< as many shares as consumers, task i in share i modulo their number
  kEqualCost,   ///< as many shares as consumers: the costliest task left goes to the share with the
                ///< lowest cost so far (Graham 1969)
  kBatches,     ///< as many in each
  kFalling      ///< for each consumer a message, then one of fewer tasks: few messages, and little
                ///< work left when the tasks are used up (factoring: Hummel, Schonberg and Flynn
                ///< 1992)
};

/// What some of the divisions need.
struct Among {
  int consumers = 1;
  std::size_t batch = 1;          ///< tasks in a message of kBatches
  std::span<const double> costs;  ///< of kEqualCost: estimates in any unit
};

/// In the order in which they are to be sent; no share is empty.
std::vector<Share> divide(ImageDivision division, std::size_t tasks, const Among& among);

/// How the tasks of that work are divided. Not for kBeams and kBlocks, which are not divided
/// before.
ImageDivision division_of(Work work);

}  // namespace beambench::cluster
