#pragma once
// What became of samples, as bytes, and put together.

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/hit_buffer.hpp"
#include "accel/core/primary_rays.hpp"
#include "harness/cluster/roles.hpp"
#include "harness/render/picture/image.hpp"
#include "harness/render/whitted.hpp"

namespace beambench::cluster {

/// Indices in a hit buffer, ascending.
using SampleList = std::span<const std::uint32_t>;

/// Appends the hits of samples, 8 bytes each and 8 for each run of neighbors.
void write_hits(SampleList samples, const accel::HitBuffer& hits, Bytes& bytes);

/// Hits from everywhere.
class HitSink : public ResultSink {
 public:
  /// Nothing is hit yet. The buffer must outlive the sink.
  explicit HitSink(accel::HitBuffer& hits) : hits_(&hits) {}
  std::size_t accept(std::span<const std::byte> result) override;

 private:
  accel::HitBuffer* hits_;
};

/// Appends what light comes along samples: a pixel that has all its samples here is 12 bytes, the
/// mean of its samples as a picture has it; other samples are 28 bytes each in double, so that the
/// sink can add a pixel's samples in their one order. `pulse` is called from time to time.
void write_colors(SampleList samples, const accel::HitBuffer& hits, const accel::PrimaryRays& rays,
                  const render::Whitted& tracer, render::Whitted::Progress& progress,
                  const Pulse& pulse, Bytes& bytes);

/// Light from everywhere: a picture equal bit for bit to `whitted_picture`.
class ColorSink : public ResultSink {
 public:
  /// `background`: along rays that hit nothing.
  ColorSink(int width, int height, int samples, const glm::dvec3& background);
  std::size_t accept(std::span<const std::byte> result) override;

  /// The picture; to be asked for when all results are in.
  render::Image image() const;

 private:
  std::size_t accept_pixels(ByteReader& reader);
  std::size_t accept_sample(ByteReader& reader);

  int samples_;
  glm::dvec3 background_;
  render::Image image_;
  /// Pixels that were divided among several tasks: all their samples.
  std::unordered_map<std::uint32_t, std::vector<glm::dvec3>> divided_;
};

}  // namespace beambench::cluster
