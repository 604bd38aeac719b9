#pragma once
// The beam tracer of the thesis.

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "accel/beam/beam_options.hpp"
#include "accel/beam/beam_painter.hpp"
#include "accel/beam/beam_run.hpp"
#include "accel/beam/beam_sight.hpp"
#include "accel/beam/beam_watch.hpp"
#include "accel/core/registry.hpp"
#include "accel/octree/samet.hpp"

namespace beambench::accel::beam {

/// Beams of primary rays through an octree (González López, thesis 1999, chapters 3 and 4): in
/// empty leaves the beams continue, divided by the faces and the leaves behind them; at an occupied
/// leaf the samples of a beam become rays; samples that leave the root are background, and no ray
/// is traced for them. Samet's traversal of the same octree traces individual rays: those that
/// continue behind an occupied leaf, and all rays other than primary rays and rays that planes
/// reflect or refract.
class BeamTracer : public octree::Samet {
 public:
  BeamTracer(const scenes::Scene& scene, const BeamOptions& options)
      : BeamTracer(scene, octree::Octree(scene, options.octree), options) {}
  /// Creates a tracer over an existing octree.
  BeamTracer(const scenes::Scene& scene, octree::Octree octree, const BeamOptions& options)
      : octree::Samet(scene, std::move(octree)), scene_(&scene), options_(options) {}

  const scenes::Scene& scene() const { return *scene_; }
  const BeamOptions& options() const { return options_; }

  /// Traces an image in beams, which are shared among the context's threads: two beams have no
  /// samples in common unless one descends from the other. In a batch, traces rays that planes
  /// reflect or refract in beams (`BehindPlane`) and all other rays one by one.
  void closest_hits(const RaySource& rays, const HitSpan& hits,
                    const QueryContext& context) const override;

  /// Returns the octree's statistics. Samples become rays only at occupied leaves, so the tracer
  /// generates its own rays.
  Statistics statistics() const override {
    Statistics statistics = octree::Samet::statistics();
    statistics.image_rays = ImageRays::kOwn;
    statistics.instruction_set = instruction_set_of(options_.leaf);
    return statistics;
  }

  using octree::Samet::path;
  SampleSteps path(const PrimaryRays& image, int x, int y, int sample) const override;

  std::optional<std::vector<BeamOutline>> beams(const PrimaryRays& rays) const override {
    OutlineBeamWatch watch(rays.width(), rays.height());
    HitBuffer buffer(rays.width(), rays.height(), rays.samples());
    trace_watched(rays, buffer, watch);
    return std::move(watch).take();
  }

  /// Returns 1 for each ray of a batch that `closest_hits` traces alone, in no beam.
  std::vector<std::uint8_t> traced_alone(const RayBatch& batch) const;

  /// Traces an image and reports to a policy (see NoBeamWatch).
  template <class Watch>
  void trace_watched(const PrimaryRays& rays, const HitSpan& buffer, Watch& watch) const;

 private:
  void trace_image(const PrimaryRays& rays, const HitSpan& hits, const QueryContext& context) const;
  void trace_batch(const RayBatch& batch, const HitSpan& hits, WorkCounters* counters) const;

  const scenes::Scene* scene_;
  BeamOptions options_;
};

template <class Watch>
void BeamTracer::trace_watched(const PrimaryRays& rays, const HitSpan& buffer, Watch& watch) const {
  const WholeImage sight;
  auto finished = finished_samples(options_, sight, buffer);
  BeamRun<Watch, WholeImage>(*scene_, *this, options_, rays, sight, buffer, finished, watch)();
}

/// Builds the beam tracer that a choice names, like `StructureChoice::build`. Also throws
/// InputError if the choice is another structure.
std::unique_ptr<BeamTracer> build_beam_tracer(const StructureChoice& choice,
                                              const scenes::Scene& scene, const Workload& workload);

}  // namespace beambench::accel::beam
