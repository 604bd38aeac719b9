#pragma once
// The rays of an image or of a list, and the query for them.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "accel/core/primary_rays.hpp"
#include "accel/core/registry.hpp"
#include "harness/rays/ray_kind.hpp"
#include "harness/rays/ray_set.hpp"
#include "scenes/base/error.hpp"
#include "scenes/scene.hpp"

namespace beambench::rays {

/// Width and height in pixels, each in 1 ... kMaxSide.
struct Resolution {
  static constexpr int kMaxSide = 16384;

  int width;
  int height;

  friend bool operator==(const Resolution&, const Resolution&) = default;
};

/// Throws InputError unless the text is `WxH` with whole numbers in 1 ... kMaxSide.
Resolution parse_resolution(std::string_view text);

/// Returns `640x480`.
std::string to_string(const Resolution& resolution);

/// Throws InputError if the image has more samples than a buffer may hold (2^28); the message names
/// the values to lower.
void require_ray_count(const Resolution& resolution, int samples);

/// The position of a primary ray in its image.
struct PixelSample {
  int x, y, sample;

  friend bool operator==(const PixelSample&, const PixelSample&) = default;
};

/// Returns the position in the image of the ray with that index, in the order of a hit buffer.
PixelSample place_of(const accel::PrimaryRays& image, std::size_t index);
/// Returns the index of a position.
std::size_t index_of(const accel::PrimaryRays& image, const PixelSample& at);
/// Returns the ray at an index.
accel::Ray ray_at(const accel::PrimaryRays& image, std::size_t index);

/// Rays by index, and the query for all of them. Cheap to copy, because lists are shared.
class TraceInput {
 public:
  /// The closest-hit query for an image.
  TraceInput(
      accel::PrimaryRays rays);  // NOLINT(google-explicit-constructor): an image implies its query
  explicit TraceInput(RaySet rays);

  std::size_t size() const;
  accel::Ray ray(std::size_t index) const;
  Query query() const { return list_ ? list_->query : Query::kClosestHit; }
  /// Returns the label; see `RayChoice::label`.
  const std::string& label() const;
  std::uint64_t seed() const { return list_ ? list_->seed : 0; }

  /// Returns the image; null for a list.
  const accel::PrimaryRays* image() const { return image_ ? &*image_ : nullptr; }
  /// Returns the list; null for an image.
  const RaySet* list() const { return list_.get(); }
  /// Returns the ray's position in the image; nothing for a list.
  std::optional<PixelSample> pixel(std::size_t index) const;

  /// Returns the largest distance of an origin from the coordinate origin.
  double reach() const;

 private:
  std::optional<accel::PrimaryRays> image_;
  std::shared_ptr<const RaySet> list_;
};

/// Returns `pixel (3, 4) sample 0` or `ray 17`.
std::string place_text(const TraceInput& input, std::size_t index);

/// Returns the `coherence` of a list, or of an image's rays in order.
double coherence(const TraceInput& input);

/// An image whose primary rays are traced, or from which other rays start.
struct ImageOfRays {
  scenes::Camera camera;
  Resolution resolution;
  int samples;

  accel::PrimaryRays rays() const { return {camera, resolution.width, resolution.height, samples}; }
};

/// Returns the image of a camera, in the camera's own resolution by default. Throws InputError if
/// it has too many rays or the number of samples is not supported.
ImageOfRays image_of(const scenes::Camera& camera, const std::optional<Resolution>& resolution,
                     int samples);

/// Returns the workload for a structure: the rays, their camera, and the number of threads.
accel::Workload workload_of(const ImageOfRays& image, const TraceInput& input, int threads = 1);

/// Thrown if a scene has no rays of a kind; the other kinds of a request are not affected.
class NoRaysError : public InputError {
 public:
  using InputError::InputError;
};

/// Throws InputError if the rays come from a file made for another scene.
void require_made_for(const scenes::Scene& scene, const RaySet& set);

/// Makes the rays of a choice, or reads them. Throws NoRaysError if the scene has no lights for
/// shadow rays or no planar mirrors for mirror rays, or if no primary ray hits anything. Throws
/// InputError for whole pictures, for files made for another scene, and where `read_ray_file` does.
TraceInput make_trace_input(const scenes::Scene& scene, const ImageOfRays& image,
                            const RayChoice& choice);

}  // namespace beambench::rays
