// Embree's native geometry as a structure for comparison.

#include <algorithm>

#include "accel/core/instruction_set.hpp"
#include "accel/core/registry.hpp"
#include "accel/core/threads.hpp"
#include "accel/embree/isa.hpp"
#include "accel/embree/native_scene.hpp"
#include "accel/embree/trace_modes.hpp"

namespace beambench::accel::embree {
namespace {

/// The queries that are flagged as coherent.
enum class Coherence { kAuto, kAll, kNone };

Coherence parse_coherence(const std::string& name) {
  if (name == "true") return Coherence::kAll;
  return name == "false" ? Coherence::kNone : Coherence::kAuto;
}

/// Deviates from the contract where Embree does: of several hits at one point it may return any,
/// not necessarily the one with the lowest id, and without `robust` it misses triangles at t =
/// t_min. No work is counted, because Embree reports none.
class EmbreeStructure : public Accelerator {
 public:
  EmbreeStructure(const scenes::Scene& scene, RTCBuildQuality quality, bool robust,
                  const TraceMode& mode, Coherence coherence, const std::string& isa,
                  ConeGeometry cones, int threads, bool moves)
      : scene_(scene, quality, robust, isa, cones, threads, moves),
        moves_(moves),
        trace_image_(image_tracers(targets_of(isa)).*mode.image),
        list_(list_tracers(targets_of(isa)).*mode.list),
        coherence_(coherence),
        isa_(isa_in_use(isa)) {}

  void closest_hits(const RaySource& rays, const HitSpan& hits,
                    const QueryContext& context) const override {
    if (const PrimaryRays* image = rays.image()) return trace_image(*image, hits, context.threads);
    if (const RayBatch* batch = rays.batch()) {
      return for_parts(batch->rays.size(), context.threads, [&](std::size_t first, std::size_t n) {
        Context query(coherence_ == Coherence::kAll);
        list_.closest_hits(scene_, query, batch->rays.subspan(first, n), hits.part(first, n));
      });
    }
    Context query(coherence_ != Coherence::kNone);
    hits.set(0, scene_.closest_hit(query, *rays.ray()));
  }
  void any_hits(const RaySource& rays, std::span<std::uint8_t> hits,
                const QueryContext& context) const override {
    if (const RayBatch* batch = rays.batch()) {
      return for_parts(batch->rays.size(), context.threads, [&](std::size_t first, std::size_t n) {
        Context query(coherence_ != Coherence::kNone);
        list_.any_hits(scene_, query, batch->rays.subspan(first, n), hits.subspan(first, n));
      });
    }
    Context query(coherence_ != Coherence::kNone);
    rays.for_each([&](std::size_t index, const Ray& ray) {
      hits[index] = scene_.any_hit(query, ray) ? 1 : 0;
    });
  }

  /// Updates the structure, if it was built for a moving scene.
  bool update(const scenes::Scene& scene) override {
    if (moves_) scene_.update(scene);
    return moves_;
  }

  Statistics statistics() const override {
    Statistics statistics;
    statistics.bytes = scene_.bytes();
    statistics.instruction_set = isa_;
    statistics.image_rays = ImageRays::kSimd;
    statistics.library_geometry = scene_.geometry_types();
    statistics.library_version = "Embree " + embree_version();
    statistics.more = {{"triangles", static_cast<double>(scene_.triangle_count())},
                       {"sphere_points", static_cast<double>(scene_.sphere_count())},
                       {"curves", static_cast<double>(scene_.curve_count())},
                       {"user_primitives", static_cast<double>(scene_.user_count())}};
    return statistics;
  }

 private:
  /// Calls `trace(first, count)` for the parts of a list of rays. On one thread, the list is one
  /// part; otherwise parts consist of whole packets and streams.
  template <class Trace>
  static void for_parts(std::size_t rays, int threads, const Trace& trace) {
    constexpr std::size_t kPart = 4096;
    const auto parts = static_cast<int>((rays + kPart - 1) / kPart);
    for_rows({.threads = threads}, parts, [&](int begin, int end, auto&) {
      const std::size_t first = kPart * static_cast<std::size_t>(begin);
      trace(first, std::min(kPart * static_cast<std::size_t>(end), rays) - first);
    });
  }
  void trace_image(const PrimaryRays& image, const HitSpan& hits, int threads) const {
    for_rows({.threads = threads}, tile_rows(image), [&](int begin, int end, auto&) {
      Context query(coherence_ != Coherence::kNone);
      trace_image_(scene_, query, image, band_of(image, begin, end), hits);
    });
  }

  NativeScene scene_;
  bool moves_;
  ImageTracers::Trace trace_image_;
  ListMode list_;
  Coherence coherence_;
  std::string isa_;
};

std::vector<std::string> mode_names() {
  std::vector<std::string> names;
  for (const TraceMode& mode : trace_modes()) names.emplace_back(mode.name);
  return names;
}

const TraceMode& find_mode(const std::string& name) {
  return *std::ranges::find(trace_modes(), name, &TraceMode::name);
}

ParameterInfo cones_parameter() {
  ParameterInfo parameter = choice_parameter(
      "cones", "callbacks", {"callbacks", "curves"},
      "test cones exactly by callbacks, one ray at a time, or as Embree's linear curves, which "
      "it closes by disks at both ends and tests in single precision: fast, but wrong where an "
      "open end is visible");
  parameter.changes_hits = true;
  return parameter;
}

RTCBuildQuality parse_quality(const std::string& name) {
  if (name == "low") return RTC_BUILD_QUALITY_LOW;
  if (name == "medium") return RTC_BUILD_QUALITY_MEDIUM;
  return RTC_BUILD_QUALITY_HIGH;
}

}  // namespace

void register_embree(Registry& registry) {
  registry.add(
      {"embree",
       "Intel Embree's BVH over its native triangles and spheres, built on one thread (Wald et "
       "al., ACM TOG 33(4), 2014)",
       Conformance::kTolerance,
       {choice_parameter("mode", "single", mode_names(),
                         "how an image is traced: ray by ray, in packets (blocks of 2x2, 4x2 or "
                         "4x4 pixels) or, by Embree 3 only, as streams of a tile's rays"),
        choice_parameter("quality", "high", {"low", "medium", "high"},
                         "Embree's build quality: low sorts by Morton codes, medium minimizes "
                         "surface area, high also splits triangles, which Embree 3 does for "
                         "robust=false only"),
        flag_parameter("robust", true,
                       "watertight traversal; without it, Embree loses rays at vertices and "
                       "edges and fails verification where these rays matter"),
        choice_parameter("coherent", "auto", {"auto", "true", "false"},
                         "flag neighboring rays as coherent, so that Embree keeps packets "
                         "together; auto: for images and any-hit queries, but not for closest "
                         "hits of lists"),
        cones_parameter(), update_parameter(), isa_parameter()},
       [](const scenes::Scene& scene, const Parameters& parameters, const Workload& workload) {
         const std::string& isa = parameters.choice("isa");
         require_isa(isa);
         return std::make_unique<EmbreeStructure>(
             scene, parse_quality(parameters.choice("quality")), parameters.flag("robust"),
             find_mode(parameters.choice("mode")), parse_coherence(parameters.choice("coherent")),
             isa,
             parameters.choice("cones") == "curves" ? ConeGeometry::kCurves
                                                    : ConeGeometry::kCallbacks,
             workload.threads, parameters.flag(update_parameter().name));
       }});
}

}  // namespace beambench::accel::embree
