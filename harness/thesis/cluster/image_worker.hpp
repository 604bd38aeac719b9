#pragma once
// The work of a consumer: computes hits or light for beams and blocks, encodes these results, and
// collects them.

#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/beam/beam_painter.hpp"
#include "accel/beam/beam_paths.hpp"
#include "accel/beam/beam_tracer.hpp"
#include "accel/beam/sample_lattice.hpp"
#include "accel/core/hit_buffer.hpp"
#include "accel/core/primary_rays.hpp"
#include "harness/render/picture/image.hpp"
#include "harness/render/whitted.hpp"
#include "harness/thesis/cluster/tasks.hpp"
#include "harness/thesis/cluster/transport.hpp"

namespace beambench::cluster {

/// Indices in a hit buffer, ascending.
using SampleList = std::span<const std::uint32_t>;

/// Appends the hits of samples: 8 bytes for each hit, and 8 for each run of adjacent samples.
void write_hits(SampleList samples, const accel::HitBuffer& hits, Bytes& bytes);

/// Collects hits.
class HitSink : public ResultSink {
 public:
  /// The buffer must be without hits, and must outlive the sink.
  explicit HitSink(accel::HitBuffer& hits) : hits_(&hits) {}
  std::size_t accept(std::span<const std::byte> result) override;

 private:
  accel::HitBuffer* hits_;
};

/// Appends the light of samples. A pixel whose samples are all given takes 12 bytes, for their
/// mean. Every other sample takes 29 bytes; its light is in double precision, so that the sink can
/// add a pixel's samples in order. `heartbeat` is called from time to time.
void write_colors(SampleList samples, const accel::HitBuffer& hits, const accel::PrimaryRays& rays,
                  const render::Whitted& tracer, render::Whitted::Progress& progress,
                  const Heartbeat& heartbeat, Bytes& bytes);

/// Collects light; the picture equals that of `whitted_picture`, bit for bit.
class ColorSink : public ResultSink {
 public:
  /// `background` is the light along rays without hits.
  ColorSink(int width, int height, int samples, const glm::dvec3& background);
  std::size_t accept(std::span<const std::byte> result) override;

  /// Returns the picture, once all results have arrived.
  render::Image image() const;

 private:
  std::size_t accept_pixels(ByteReader& reader);
  std::size_t accept_sample(ByteReader& reader);

  int samples_;
  glm::dvec3 background_;
  render::Image image_;
  /// All samples of the pixels that were divided among several tasks.
  std::unordered_map<std::uint32_t, std::vector<glm::dvec3>> divided_;
};

/// Records the samples decided by a beam.
class DecidedSamples : public accel::beam::NoBeamWatch {
 public:
  /// Restricts the beams' samples to a part of the image; if `part` is empty, to all of it.
  void want(std::vector<accel::beam::SampleLattice> part) { part_ = std::move(part); }
  std::span<const accel::beam::SampleLattice> chosen(
      std::span<const accel::beam::SampleLattice> all) const {
    return part_.empty() ? all : part_;
  }

  /// Clears the record. `heartbeat` is called from time to time and must outlive this object.
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
  std::vector<accel::beam::SampleLattice> part_;
  std::vector<std::uint32_t> samples_;
  const Heartbeat* pulse_ = nullptr;
};

/// Finds the samples of a beam (thesis, section 6.2.3, "BuscarPixel") and traces them, with light
/// if requested; for a tile, it also makes the beams. Each process has one.
class ImageWorker : public TaskWorker {
 public:
  /// Results are hits, or light if `light` is given. All arguments must outlive this object.
  ImageWorker(const accel::beam::BeamTracer& tracer, const accel::PrimaryRays& rays,
              const render::Whitted* light);

  void perform(std::span<const std::byte> task, Bytes& result, const Heartbeat& heartbeat) override;
  /// Returns the number of samples in its results so far.
  std::uint64_t samples() const { return samples_; }
  /// Writes the worker's census of rays.
  void write_counts(Bytes& bytes) const override;

 private:
  /// Data needed to write the samples of a task once they are decided.
  struct Results {
    Bytes* bytes;
    const Heartbeat* heartbeat;
  };
  void perform(const BeamTask& task, const Results& results);
  void perform(const BlockTask& task, const Results& results);
  void perform(const TileTask& task, const Results& results);
  void trace_beams_through(const accel::beam::PixelRect& tile);
  /// Writes the results of the decided samples.
  void write(const Results& results);

  const accel::beam::BeamTracer* tracer_;
  const accel::PrimaryRays* rays_;
  const render::Whitted* light_;
  accel::beam::EyeView view_;
  accel::beam::WholeImage sight_;
  std::vector<accel::beam::SampleLattice> lattices_;
  accel::HitBuffer hits_;
  DecidedSamples decided_;
  accel::beam::BeamQueue queue_;
  accel::beam::BeamPainter<DecidedSamples, accel::beam::WholeImage> painter_;
  std::uint64_t samples_ = 0;
  render::RayCensus census_;
};

/// Reads the output of `ImageWorker::write_counts`. Throws ProtocolError for other bytes.
render::RayCensus read_census(std::span<const std::byte> bytes);

}  // namespace beambench::cluster
