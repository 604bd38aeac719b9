#pragma once
// Divides an image into parts, and distributes the parts over messages to consumers.

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "accel/beam/sample_lattice.hpp"

namespace beambench::cluster {

/// The kinds of tasks and their distribution. All except the first three are static (thesis,
/// section 2.3.2.1): each consumer receives all its work in one message.
enum class Work {
  kBeams,       ///< the producer's beams to occupied leaves, to any waiting consumer (chapter 6)
  kBlocks,      ///< blocks of individual rays, to any waiting consumer
  kTiles,       ///< blocks whose beams the consumers make, in messages of decreasing size
  kContiguous,  ///< neighboring rows of individual rays (Hu and Foley 1985)
  kInterlaced,  ///< the i-th of P consumers gets the rows i, i + P, ... (Isler and Özgüç 1991)
  kWindows,     ///< like kInterlaced, with blocks instead of rows
  kPrePass      ///< blocks by their estimated costs (Salmon and Goldsmith 1988; Priol 1989)
};

/// Returns the name of the work on the command line.
std::string_view name_of(Work work);
/// Returns the work of that name; nothing for any other string.
std::optional<Work> work_named(std::string_view name);
bool is_static(Work work);

/// Returns the blocks of an image of width x height pixels, row by row, smaller at the right and
/// lower border.
std::vector<accel::beam::PixelRect> blocks_of(int width, int height, int block_width,
                                              int block_height);

/// The blocks of an image, ordered so that consecutive blocks are spread over the image: an
/// additive recurrence in both directions (Kronecker; its constants are Roberts's, "The
/// unreasonable effectiveness of quasirandom sequences", 2018). All processes compute the same
/// order, so a range of numbers identifies blocks.
class TileOrder {
 public:
  /// Orders the tiles, of size x size, of an image of width x height pixels.
  TileOrder(int width, int height, int size);

  std::size_t count() const { return columns_ * rows_; }
  /// Returns the i-th tile; tiles are smaller at the right and lower border.
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

/// The methods of dividing tasks 0 ... `tasks` - 1 into messages.
enum class ImageDivision {
  kContiguous,  ///< as many shares as consumers, each of consecutive tasks
  kInterlaced,  ///< as many shares as consumers; task i is in share i modulo their number
  kEqualCost,   ///< as many shares as consumers: the costliest remaining task goes to the share
                ///< with the lowest cost so far (Graham 1969)
  kBatches,     ///< shares of equal size
  kFalling      ///< one message for each consumer, then messages with ever fewer tasks: few
                ///< messages, and little work left when the tasks run out (factoring: Hummel,
                ///< Schonberg and Flynn 1992)
};

/// Parameters of the divisions.
struct Among {
  int consumers = 1;
  std::size_t batch = 1;          ///< tasks in a message of kBatches
  std::span<const double> costs;  ///< for kEqualCost: estimates in any unit
};

/// Divides the tasks into shares in the order of sending; no share is empty.
std::vector<Share> divide(ImageDivision division, std::size_t tasks, const Among& among);

/// Returns the division of the tasks of that work. Must not be called for kBeams and kBlocks, whose
/// tasks are not divided in advance.
ImageDivision division_of(Work work);

}  // namespace beambench::cluster
