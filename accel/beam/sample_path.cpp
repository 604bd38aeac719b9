#include "accel/beam/sample_path.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "accel/core/trace_step.hpp"

namespace beambench::accel::beam {
namespace {

bool same(const BeamCut& a, const BeamCut& b) {
  const auto equal = [](const Crossing& c, const Crossing& d) {
    return c.index == d.index && c.axis == d.axis && c.side == d.side;
  };
  return equal(a.first, b.first) && equal(a.second, b.second);
}

/// Records the beams of one sample, and lets the painter trace that sample alone.
class SampleWatch : public NoBeamWatch {
 public:
  SampleWatch(const BeamTracer& tracer, const PrimaryRays& rays, const SampleLattice& only,
              StepRecorder& recorder)
      : octree_(&tracer.octree()),
        view_(tracer.octree().grid(), rays),
        scan_(view_, rays),
        all_(sample_lattices(rays, tracer.options().share_corners)),
        only_(&only),
        ray_(scan_.ray(only, 0, 0)),
        way_(tracer.octree().grid(), ray_),
        t_(way_.enter(ray_.t_min)),
        pixels_(rays.width(), rays.height()),
        recorder_(&recorder) {
    entered_ = face_of_root();
  }

  std::span<const SampleLattice> chosen(std::span<const SampleLattice>) const { return {only_, 1}; }
  StepRecorder& rays() const { return *recorder_; }

  void met(BeamKind kind, const Beam& beam) {
    if (samples_of(beam, *only_) == 0) return;
    BeamPassage passage;
    passage.kind = kind;
    passage.node = beam.node;
    octree::OctreeCursor leaf(*octree_);
    leaf.jump(beam.node, beam.corner, beam.size);
    passage.level = leaf.level();
    passage.cell = octree_->grid().box(beam.corner, beam.size);
    passage.entered = entered_;
    for (const glm::dvec2& corner : beam.outline) passage.corners.push_back(corner * pixels_);
    passage.cuts = new_cuts(beam);
    for (const SampleLattice& lattice : all_) passage.samples += samples_of(beam, lattice);
    passages_.push_back(std::move(passage));
    last_cuts_.assign(beam.cuts.begin(), beam.cuts.end());
    if (kind == BeamKind::kLeaving) return;

    const octree::LeafExit exit = octree::leaf_exit(way_, leaf);
    if (kind == BeamKind::kOccupied) {
      recorder_->enter([&] {
        return TraceStep{.place = "leaf",
                         .index = beam.node,
                         .level = leaf.level(),
                         .box = octree_->grid().box(beam.corner, beam.size),
                         .t_enter = std::max(t_, static_cast<double>(ray_.t_min)),
                         .t_exit = exit.t};
      });
    }
    t_ = exit.t;
    entered_ = face_of(leaf, exit);
  }
  void handed_over(RayReason reason) { reason_ = reason; }

  SamplePath take() && {
    return {std::move(passages_), std::move(*recorder_).take_steps(), reason_, {}};
  }

 private:
  std::uint64_t samples_of(const Beam& beam, const SampleLattice& lattice) const {
    std::uint64_t samples = 0;
    const auto ray_at = [&](int x, int y) { return scan_.ray(lattice, x, y); };
    scan_.for_each_run(beam, lattice, ray_at, [&](int, int first, int last) {
      samples += static_cast<std::uint64_t>(last - first + 1);
    });
    return samples;
  }

  std::vector<PlaneOrder> new_cuts(const Beam& beam) const {
    std::vector<PlaneOrder> cuts;
    for (const BeamCut& cut : beam.cuts) {
      if (std::ranges::any_of(last_cuts_, [&](const BeamCut& old) { return same(cut, old); })) {
        continue;
      }
      cuts.push_back({plane_of(cut.first), plane_of(cut.second)});
    }
    return cuts;
  }

  CrossedPlane plane_of(const Crossing& crossing) const {
    return {crossing.axis, octree_->grid().plane(crossing.axis, crossing.index)};
  }

  /// Returns the face of the root through which the ray enters: of the faces visible to the eye,
  /// the one it crosses last.
  std::optional<CrossedPlane> face_of_root() const {
    std::optional<Crossing> last;
    for (int axis = 0; axis < 3; ++axis) {
      const std::int32_t cells = octree_->grid().cells[axis];
      const bool below = view_.eye(axis) < octree_->grid().plane(axis, 0);
      if (!below && view_.eye(axis) <= octree_->grid().plane(axis, cells)) continue;
      const Crossing face{below ? 0 : cells, static_cast<std::int16_t>(axis),
                          static_cast<std::int16_t>(below ? 1 : -1)};
      if (!last || crosses_before(way_, *last, face)) last = face;
    }
    if (!last) return std::nullopt;
    return plane_of(*last);
  }

  /// Returns the face through which beams enter the next leaf. If the ray crosses several faces at
  /// the same t, returns the one with the lowest axis, as in `crosses_before`.
  CrossedPlane face_of(const octree::OctreeCursor& leaf, const octree::LeafExit& exit) const {
    int axis = 0;
    while (axis < 2 && exit.step[axis] == 0) ++axis;
    const std::int32_t index = leaf.corner()[axis] + (exit.step[axis] > 0 ? leaf.size() : 0);
    return {axis, octree_->grid().plane(axis, index)};
  }

  const octree::Octree* octree_;
  EyeView view_;
  SampleScan scan_;
  std::vector<SampleLattice> all_;
  const SampleLattice* only_;
  Ray ray_;
  CellRay way_;
  double t_;
  glm::dvec2 pixels_;
  StepRecorder* recorder_;
  std::vector<BeamPassage> passages_;
  std::vector<BeamCut> last_cuts_;
  std::optional<CrossedPlane> entered_;
  std::optional<RayReason> reason_;
};

}  // namespace

SamplePath path_of_sample(const BeamTracer& tracer, const PrimaryRays& rays, int x, int y,
                          int sample) {
  const glm::dvec2 in_pixel = rays.offsets()[static_cast<std::size_t>(sample)];
  const SampleLattice only{in_pixel + glm::dvec2(x, y), 1, 1, {{0, 0, 0}}};
  StepRecorder recorder;
  SampleWatch watch(tracer, rays, only, recorder);
  HitBuffer buffer(1, 1, 1);
  tracer.trace_watched(rays, buffer, watch);
  SamplePath path = std::move(watch).take();
  path.hit = buffer.get(0);
  return path;
}

SampleSteps BeamTracer::path(const PrimaryRays& image, int x, int y, int sample) const {
  SamplePath followed = path_of_sample(*this, image, x, y, sample);
  return {std::move(followed.beams), std::move(followed.steps)};
}

}  // namespace beambench::accel::beam
