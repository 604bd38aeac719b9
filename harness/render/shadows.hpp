#pragma once
// Options for a picture's ray depth and shadow rays, and the tracing of shadow rays.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/accelerator.hpp"
#include "accel/core/ray.hpp"
#include "harness/rays/hit_check.hpp"
#include "harness/rays/ray_kind.hpp"
#include "harness/render/ray_census.hpp"
#include "scenes/scene.hpp"

namespace beambench::render {

/// Methods of deciding the visibility of a light. All of them yield the same picture, unless
/// something opaque is closer behind glass than the distance from surfaces at which rays begin
/// (`surface_lift`).
enum class ShadowMethod {
  kRays,        ///< one any-hit query per light
  kCache,       ///< first test the opaque primitive that hid the light last (OORT; `ShadowCache`)
  kLightBuffer  ///< list primitives in advance by direction from the light (`LightBuffer`)
};

/// The names after --shadows, in the order of `ShadowMethod`.
std::span<const std::string_view> shadow_method_names();
/// Throws InputError listing the valid names.
ShadowMethod parse_shadow_method(std::string_view name);

struct WhittedOptions {
  /// Maximum ray depth, including the primary ray: 5 in Haines's databases (SPD).
  int max_depth = 5;
  /// Adaptive depth control (Hall and Greenberg, "A testbed for realistic image synthesis", IEEE
  /// CG&A 3(8), 1983): trace a secondary ray only if it contributes at least this much to its
  /// pixel. 0 traces all.
  double min_weight = 0.0;
  ShadowMethod shadows = ShadowMethod::kRays;
  /// The maximum number of rays of the same depth that are shaded together, and whose secondary
  /// rays are traced together: 1 ... rays::kMaxPictureBatch. Exact structures yield the same
  /// picture for any value.
  int batch = rays::kPictureBatch;
  /// Spawn a mirror ray at glass even if the specular factor is 0 and the ray does not contribute
  /// to the picture: rule 8 of Haines's databases (SPD), whose counts include these rays.
  bool glass_always_mirrors = false;
};

/// Returns the options of a whole picture as a kind of rays: `whitted:depth=3,shadows=cache`.
WhittedOptions whitted_options(const rays::RayChoice& choice);

/// The light buffer (Haines and Greenberg, "The light buffer: a shadow-testing accelerator", IEEE
/// CG&A 6(9), 1986): the faces of a cube about a light are divided into cells, and each cell lists
/// the primitives that may be visible through it, the nearest first. A shadow ray's cell lists all
/// primitives that the ray can meet, so the result is the same as with all primitives.
class LightBuffer {
 public:
  /// `cells` is the number of cells along an edge of the cube, at least 1. The scene must outlive
  /// the buffer.
  LightBuffer(const scenes::Scene& scene, const glm::vec3& light, int cells);

  enum class Visibility {
    kFree,         ///< nothing in front of the light
    kHidden,       ///< something opaque
    kTransparent,  ///< something transparent, nothing opaque: the remaining light must be followed
  };
  /// Classifies what lies on a shadow ray: `to_light` begins at a point and has the light at t = 1.
  /// Adds the number of ray-primitive tests to `tests`.
  Visibility visibility(const accel::Ray& to_light, std::uint64_t& tests) const;

  std::size_t memory_bytes() const;

 private:
  struct Entry {
    double near;  ///< the distance from the light
    scenes::PrimitiveId primitive;
  };
  std::size_t cell_of(const glm::dvec3& direction) const;

  const scenes::Scene* scene_;
  glm::dvec3 light_;
  int cells_;
  std::vector<std::uint32_t> first_;  ///< each cell's first entry; last, the number of entries
  std::vector<Entry> entries_;
};

/// The opaque primitive that last hid each light, for each depth of rays (as in the ray tracer
/// OORT; Wilt, Object-Oriented Ray Tracing in C++, 1994): neighboring points are mostly hidden by
/// the same primitive.
struct ShadowCache {
  ShadowCache(std::size_t lights, int depths)
      : last(lights * static_cast<std::size_t>(depths), scenes::kNoPrimitive) {}

  std::vector<scenes::PrimitiveId> last;  ///< by depth, then by light
};

/// Traces shadow rays over a structure. Queries are const and thread-safe if each thread has a
/// separate cache.
class Shadows {
 public:
  /// Builds light buffers if the options require them. Scene and structure must outlive this
  /// object.
  Shadows(const scenes::Scene& scene, const accel::Accelerator& structure,
          const WhittedOptions& options, rays::HitCheck check);

  /// Returns the transmitted fraction of a light for each ray: 0 if an opaque primitive hides it,
  /// otherwise the product of the transmittances of the transparent surfaces in between (1 if there
  /// are none). Each ray of `to_light` begins at a point, `depth` rays from the camera (the camera
  /// ray is 1), and has the light at t = 1; the cache processes them in order. The rays need no
  /// marks, because the rays of a batch are a pencil. Throws InvalidHit.
  std::vector<double> transmitted(const accel::RayBatch& to_light, std::size_t light, int depth,
                                  ShadowCache& cache, RayCensus& census) const;

  /// Returns the size of the light buffers in bytes; 0 without light buffers.
  std::size_t memory_bytes() const;

 private:
  double asked_by_cache(const accel::Ray& to_light, scenes::PrimitiveId& last,
                        RayCensus& census) const;
  double asked_by_buffer(const accel::Ray& to_light, std::size_t light, RayCensus& census) const;
  std::vector<double> asked_at_once(const accel::RayBatch& to_light, std::size_t light,
                                    RayCensus& census) const;
  std::vector<double> followed(const accel::RayBatch& to_light, std::size_t light,
                               RayCensus& census) const;
  double followed(accel::Ray ray, scenes::PrimitiveId& blocker, RayCensus& census) const;
  float passed_through(accel::Ray& ray, const accel::Hit& hit) const;
  /// Returns a pencil of all rays in a batch, if there are enough of them.
  std::vector<accel::Pencil> pencil(std::size_t light, std::size_t rays) const;

  const scenes::Scene* scene_;
  const accel::Accelerator* structure_;
  rays::HitCheck check_;
  ShadowMethod method_;
  bool all_opaque_;
  std::vector<LightBuffer> buffers_;  ///< one per light, or empty
};

}  // namespace beambench::render
