#pragma once
// The rays of an image or of a list, and the query that a structure is to answer for them.

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

/// Throws InputError when the text is not `WxH` with whole numbers in 1 ... kMaxSide.
Resolution parse_resolution(std::string_view text);

/// `640x480`.
std::string to_string(const Resolution& resolution);

/// Throws InputError when the image has more samples than a buffer is meant for (2^28), naming
/// what to lower.
void require_ray_count(const Resolution& resolution, int samples);

/// The place of a primary ray in its image.
struct PixelSample {
  int x, y, sample;

  friend bool operator==(const PixelSample&, const PixelSample&) = default;
};

/// Where in its image the ray of that index is, as a hit buffer counts them.
PixelSample place_of(const accel::PrimaryRays& image, std::size_t index);
/// The other way round.
std::size_t index_of(const accel::PrimaryRays& image, const PixelSample& at);
/// The ray itself.
accel::Ray ray_at(const accel::PrimaryRays& image, std::size_t index);

/// Rays by their index, and one query for all of them. A small value: lists are shared.
class TraceInput {
 public:
  /// The closest hits of an image.
  TraceInput(
      accel::PrimaryRays rays);  // NOLINT(google-explicit-constructor): an image implies its query
  explicit TraceInput(RaySet rays);

  std::size_t size() const;
  accel::Ray ray(std::size_t index) const;
  Query query() const { return list_ ? list_->query : Query::kClosestHit; }
  /// As `RayChoice::label`.
  const std::string& label() const;
  std::uint64_t seed() const { return list_ ? list_->seed : 0; }

  /// The image; nothing for a list.
  const accel::PrimaryRays* image() const { return image_ ? &*image_ : nullptr; }
  /// The list; nothing for an image.
  const RaySet* list() const { return list_.get(); }
  /// Where in the image the ray is; nothing for a list.
  std::optional<PixelSample> pixel(std::size_t index) const;

  /// The largest distance of an origin from the origin of the coordinates.
  double reach() const;

 private:
  std::optional<accel::PrimaryRays> image_;
  std::shared_ptr<const RaySet> list_;
};

/// `pixel (3, 4) sample 0`, `ray 17`.
std::string place_text(const TraceInput& input, std::size_t index);

/// `coherence` of a list, or of an image's rays in their order.
double coherence(const TraceInput& input);

/// The image whose primary rays are traced, or that other rays start from.
struct ImageOfRays {
  scenes::Camera camera;
  Resolution resolution;
  int samples;

  accel::PrimaryRays rays() const { return {camera, resolution.width, resolution.height, samples}; }
};

/// The image of a camera, in the camera's own resolution if none is given. Throws InputError where
/// it has too many rays or no such number of samples exists.
ImageOfRays image_of(const scenes::Camera& camera, const std::optional<Resolution>& resolution,
                     int samples);

/// What a structure is built for: the rays, the camera behind them, and the threads that trace.
accel::Workload workload_of(const ImageOfRays& image, const TraceInput& input, int threads = 1);

/// There are no rays of a kind over a scene; the other kinds of a request are not affected.
class NoRaysError : public InputError {
 public:
  using InputError::InputError;
};

/// Throws InputError for rays of a file that states that they were made for another scene.
void require_made_for(const scenes::Scene& scene, const RaySet& set);

/// Makes the rays of a choice, or reads them. Throws NoRaysError where the scene has no lights for
/// shadow rays or no planar mirrors for mirror rays, or no primary ray hits anything for rays to
/// start from; InputError for whole pictures, and as `read_ray_file`; for a file also when it was
/// made for another scene.
TraceInput make_trace_input(const scenes::Scene& scene, const ImageOfRays& image,
                            const RayChoice& choice);

}  // namespace beambench::rays
