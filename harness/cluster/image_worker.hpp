#pragma once
// Beams and blocks to hits or light: what a consumer computes.

#include <cstdint>
#include <span>
#include <vector>

#include "accel/beam/beam_painter.hpp"
#include "accel/beam/beam_tracer.hpp"
#include "harness/cluster/roles.hpp"
#include "harness/cluster/task_message.hpp"
#include "harness/render/whitted.hpp"

namespace beambench::cluster {

/// Notes which samples a beam decided.
class DecidedSamples : public accel::beam::NoBeamWatch {
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
  ImageWorker(const accel::beam::BeamTracer& tracer, const accel::PrimaryRays& rays,
              const render::Whitted* light);

  void perform(std::span<const std::byte> task, Bytes& result, const Pulse& pulse) override;
  /// Its census of rays.
  void tell(Bytes& bytes) const override;

 private:
  void trace(const BeamTask& task);
  void trace(const BlockTask& task);

  const accel::beam::BeamTracer* tracer_;
  const accel::PrimaryRays* rays_;
  const render::Whitted* light_;
  accel::beam::EyeView view_;
  accel::beam::WholeImage sight_;
  accel::HitBuffer hits_;
  DecidedSamples decided_;
  accel::beam::BeamPainter<DecidedSamples, accel::beam::WholeImage> painter_;
  render::RayCensus census_;
};

/// What `ImageWorker::tell` tells. Throws ProtocolError where it is nothing of that kind.
render::RayCensus read_census(std::span<const std::byte> bytes);

}  // namespace beambench::cluster
