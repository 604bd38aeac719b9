#pragma once
// Tasks whose messages were planned before the first is sent.

#include <cstddef>
#include <span>
#include <vector>

#include "accel/beam/sample_lattice.hpp"
#include "harness/thesis/cluster/image_division.hpp"
#include "harness/thesis/cluster/messages.hpp"
#include "harness/thesis/cluster/transport.hpp"

namespace beambench::cluster {

/// Tasks share by share, a message for each.
class PlannedSource : public TaskSource {
 public:
  /// The tasks as `write_task` wrote them; `estimates` of their seconds, or none.
  PlannedSource(std::vector<Bytes> tasks, std::vector<Share> shares, std::vector<double> estimates);

  bool next(Bytes& task) override;
  std::size_t parcel_size() const override;
  double estimate() const override;

 private:
  std::vector<Bytes> tasks_;
  std::vector<Share> shares_;
  std::vector<double> estimates_;
  std::size_t share_ = 0;
  std::size_t place_ = 0;  ///< in the share
  std::size_t last_ = 0;   ///< task that was made
};

/// For each block the CPU seconds that its pixels should take, from one of each 16 x 16 pixels (the
/// block's middle where it is smaller), which `worker` traces: the pre-processing with an image of
/// low quality of Salmon and Goldsmith (1988) and Priol and Bouatouch (1989).
std::vector<double> estimate_costs(std::span<const accel::beam::PixelRect> blocks,
                                   TaskWorker& worker);

}  // namespace beambench::cluster
