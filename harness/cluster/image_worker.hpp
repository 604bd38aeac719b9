#pragma once
// Beams and blocks to hits or light: what a consumer computes.

#include <cstdint>
#include <span>
#include <vector>

#include "accel/beam/beam_painter.hpp"
#include "accel/beam/beam_tracer.hpp"
#include "harness/cluster/roles.hpp"
#include "harness/cluster/task_message.hpp"
#include "harness/shade/whitted.hpp"

namespace beambench {

/// Notes which samples a beam decided.
class DecidedSamples : public NoBeamWatch {
 public:
  /// Begins anew; `pulse` is called from time to time and must outlive the notes.
  void begin(const Pulse& pulse) {
    pulse_ = &pulse;
    samples_.clear();
  }
  void painted(std::size_t index) {
    samples_.push_back(static_cast<std::uint32_t>(index));
    if (samples_.size() % 64 == 0) (*pulse_)();
  }
  std::vector<std::uint32_t>& samples() { return samples_; }

 private:
  std::vector<std::uint32_t> samples_;
  const Pulse* pulse_ = nullptr;
};

/// Finds the samples of a beam (thesis, section 6.2.3, "BuscarPixel") and traces them; where light
/// is wanted it follows it, too. One for each process.
class ImageWorker : public TaskWorker {
 public:
  /// Results are hits, or light where `light` is given. All must outlive this.
  ImageWorker(const BeamTracer& tracer, const PrimaryRays& rays, const Whitted* light);

  void perform(std::span<const std::byte> task, Bytes& result, const Pulse& pulse) override;
  /// Its census of rays.
  void tell(Bytes& bytes) const override;

 private:
  void trace(const BeamTask& task);
  void trace(const BlockTask& task);

  const BeamTracer* tracer_;
  const PrimaryRays* rays_;
  const Whitted* light_;
  EyeView view_;
  WholeImage sight_;
  HitBuffer hits_;
  DecidedSamples decided_;
  BeamPainter<DecidedSamples, WholeImage> painter_;
  RayCensus census_;
};

/// What `ImageWorker::tell` tells. Throws ProtocolError where it is nothing of that kind.
RayCensus read_census(std::span<const std::byte> bytes);

}  // namespace beambench
