#pragma once
// Where the producer's tasks come from.

#include "accel/beam/beam_tracer.hpp"
#include "harness/cluster/roles.hpp"
#include "harness/cluster/task_message.hpp"

namespace beambench::cluster {

/// The walk of the beams (thesis, section 6.2.2): goes on with those in empty leaves and ends those
/// that leave the scene; those that come to an occupied leaf are the tasks. Of leaving beams
/// nothing is left to do, for the image begins as background.
class BeamSource : public TaskSource {
 public:
  /// Both must outlive this. Throws InputError where the tracer lets beams go on behind occupied
  /// leaves, which would have to come back for it.
  BeamSource(const accel::beam::BeamTracer& tracer, const accel::PrimaryRays& rays);

  bool next(Bytes& task) override;

 private:
  /// Why an empty leaf's beam becomes rays, if it does.
  std::optional<BeamTask::Kind> as_rays(const accel::beam::Beam& beam) const;

  const accel::beam::BeamTracer* tracer_;
  accel::beam::EyeView view_;
  double samples_;
  accel::beam::BeamQueue queue_;
};

/// Blocks of the image, row by row: what ray tracers without beams share out.
class BlockSource : public TaskSource {
 public:
  /// Blocks of `size` x `size` pixels, less at the right and lower border.
  BlockSource(int width, int height, int size);

  bool next(Bytes& task) override;

 private:
  int width_;
  int height_;
  int size_;
  int left_ = 0;
  int top_ = 0;
};

}  // namespace beambench::cluster
