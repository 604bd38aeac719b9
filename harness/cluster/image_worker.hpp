#pragma once
// What a consumer computes: the hits or light of beams and blocks.

#include <cstdint>
#include <span>
#include <vector>

#include "accel/beam/beam_painter.hpp"
#include "accel/beam/beam_tracer.hpp"
#include "harness/cluster/roles.hpp"
#include "harness/cluster/tasks.hpp"
#include "harness/render/whitted.hpp"

namespace beambench::cluster {

/// Records which samples a beam decided.
class DecidedSamples : public accel::beam::NoBeamWatch {
 public:
  /// Clears; `heartbeat` is called from time to time and must outlive the record.
  void begin(const Heartbeat& heartbeat) {
    pulse_ = &heartbeat;
    samples_.clear();
  }
  void painted(std::size_t index) {
    samples_.push_back(static_cast<std::uint32_t>(index));
    if (samples_.size() % 64 == 0) (*pulse_)();
  }
  std::vector<std::uint32_t>& samples() { return samples_; }

 private:
  std::vector<std::uint32_t> samples_;
  const Heartbeat* pulse_ = nullptr;
};

/// Finds the samples of a beam (thesis, section 6.2.3, "BuscarPixel") and traces them, with light
/// if requested. One for each process.
class ImageWorker : public TaskWorker {
 public:
  /// Results are hits, or light where `light` is given. All must outlive this.
  ImageWorker(const accel::beam::BeamTracer& tracer, const accel::PrimaryRays& rays,
              const render::Whitted* light);

  void perform(std::span<const std::byte> task, Bytes& result, const Heartbeat& heartbeat) override;
  /// Its census of rays.
  void write_counts(Bytes& bytes) const override;

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

/// Reads what `ImageWorker::write_counts` wrote. Throws ProtocolError for other bytes.
render::RayCensus read_census(std::span<const std::byte> bytes);

}  // namespace beambench::cluster
