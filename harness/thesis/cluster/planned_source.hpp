#pragma once
// Plans the messages that contain tasks before the first one is sent.

#include <cstddef>
#include <span>
#include <vector>

#include "accel/beam/sample_lattice.hpp"
#include "harness/thesis/cluster/image_division.hpp"
#include "harness/thesis/cluster/messages.hpp"
#include "harness/thesis/cluster/transport.hpp"

namespace beambench::cluster {

/// Provides tasks share by share, one message for each share.
class PlannedSource : public TaskSource {
 public:
  /// `tasks` are as written by `write_task`; `estimates` are their times in seconds, or empty.
  PlannedSource(std::vector<Bytes> tasks, std::vector<Share> shares, std::vector<double> estimates);

  bool next(Bytes& task) override;
  std::size_t parcel_size() const override;
  double estimate() const override;

 private:
  std::vector<Bytes> tasks_;
  std::vector<Share> shares_;
  std::vector<double> estimates_;
  std::size_t share_ = 0;
  std::size_t place_ = 0;  ///< position in the share
  std::size_t last_ = 0;   ///< the last task made
};

/// Estimates the CPU seconds of each block's pixels by tracing, with `worker`, one pixel in each 16
/// x 16 (in a smaller block, the middle pixel): the low-quality preprocessing image of Salmon and
/// Goldsmith (1988) and Priol and Bouatouch (1989).
std::vector<double> estimate_costs(std::span<const accel::beam::PixelRect> blocks,
                                   TaskWorker& worker);

}  // namespace beambench::cluster
