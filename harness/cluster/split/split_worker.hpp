#pragma once
// Tracing the part of a scene that one process has.

#include <deque>
#include <optional>
#include <vector>

#include "accel/beam/beam_painter.hpp"
#include "accel/beam/beam_tracer.hpp"
#include "harness/cluster/split/border.hpp"
#include "harness/cluster/split/scene_split.hpp"

namespace beambench::cluster {

/// Which leaves of a process's octree are other processes' cells.
class ForeignLeaves {
 public:
  ForeignLeaves(const accel::octree::Octree& octree, const SceneSplit& split, ProcessId self);

  /// The cell that a leaf stands for; nothing where it is our own.
  std::optional<std::uint32_t> cell_at(std::uint32_t leaf) const {
    if (cells_[leaf] == kOwn) return std::nullopt;
    return cells_[leaf];
  }
  std::size_t memory_bytes() const { return cells_.capacity() * sizeof(std::uint32_t); }

 private:
  static constexpr std::uint32_t kOwn = 0xFFFFFFFFU;
  std::vector<std::uint32_t> cells_;  ///< by node
};

/// Notes which samples beams decided, and which went on as rays into a foreign leaf.
class BorderWatch : public accel::beam::NoBeamWatch {
 public:
  BorderWatch(const accel::octree::Octree& octree, const ForeignLeaves& foreign)
      : nodes_(octree.nodes().data()), foreign_(&foreign) {}

  bool leaves_part(const accel::octree::OctreeNode& leaf, double t) {
    const auto cell = foreign_->cell_at(static_cast<std::uint32_t>(&leaf - nodes_));
    if (cell) crossing_ = Crossed{*cell, 0, t};
    return cell.has_value();
  }
  void painted(std::size_t index) {
    const auto sample = static_cast<std::uint32_t>(index);
    if (crossing_) {
      crossed.push_back({crossing_->cell, sample, crossing_->t});
      crossing_.reset();
    } else {
      decided.push_back(sample);
    }
  }

  struct Crossed {
    std::uint32_t cell;
    std::uint32_t sample;
    double t;
  };
  std::vector<std::uint32_t> decided;
  std::vector<Crossed> crossed;

 private:
  const accel::octree::OctreeNode* nodes_;
  const ForeignLeaves* foreign_;
  std::optional<Crossed> crossing_;
};

/// Takes what leaves a process's part.
class BorderPost {
 public:
  BorderPost() = default;
  BorderPost(const BorderPost&) = delete;
  BorderPost& operator=(const BorderPost&) = delete;
  virtual ~BorderPost() = default;
  virtual void hand_over(const CrossingBeam& beam) = 0;
  virtual void hand_over(const CrossingRay& ray) = 0;
};

/// What a piece of work was.
enum class SplitWork {
  kNone,
  kWalking,  ///< of beams through empty leaves
  kTesting,  ///< of samples in occupied leaves, and of the rays behind them
  kTaking,   ///< of what others handed over, out of a message
};

/// The beam tracer over a part of a scene: beams and rays that come to the border are handed over,
/// rays with the best they found, and others' go on here. Together, the processes find for each
/// sample what one process with the whole scene finds, bit for bit: beams are divided by the same
/// planes, a primitive is tested in every cell that it reaches into, and ties go to the lowest id
/// of the whole scene.
class SplitWorker : private accel::beam::BeamBorder {
 public:
  /// Takes the process's part of the scene and begins the beams that begin in it. Rays and post
  /// must outlive the worker. Throws InputError for options that do not go together with a part.
  SplitWorker(ScenePart part, const SceneSplit& split, ProcessId self,
              const accel::beam::BeamOptions& options, const accel::PrimaryRays& rays,
              BorderPost& post);
  SplitWorker(const SplitWorker&) = delete;
  SplitWorker& operator=(const SplitWorker&) = delete;
  ~SplitWorker() override = default;

  /// What others handed over, to be worked at later. Throws ProtocolError where its cell is not
  /// this process's.
  void take(const CrossingBeam& beam);
  void take(const CrossingRay& ray);

  /// Does a part of what there is to do, if anything, and says what it was.
  SplitWork work();

  /// The samples that were found here to hit something, ascending, and what they hit.
  std::vector<std::uint32_t> hit_samples() const;
  const accel::HitBuffer& hits() const { return found_; }

  const accel::beam::EyeView& view() const { return view_; }
  const scenes::Scene& scene() const { return part_.scene; }
  std::uint64_t structure_bytes() const;

 private:
  /// Rays that are traced, and beams that are walked, between two looks at the messages.
  static constexpr std::size_t kRaysAtOnce = 256;
  static constexpr std::size_t kBeamsAtOnce = 32;

  enum class EndOfWalk { kOccupied, kCrowded, kHandover };

  bool takes(std::uint32_t leaf, const accel::beam::Crossing& face,
             const accel::beam::Beam& beam) override;
  void trace_rays();
  bool has_next();
  /// The eye's leaf may be another's.
  bool is_foreign(const accel::beam::Beam& beam) const {
    return foreign_.cell_at(beam.node).has_value();
  }
  std::optional<EndOfWalk> end_of_walk(const accel::beam::BeamStep& step) const;
  void walk(const accel::beam::BeamStep& step);
  void test(const accel::beam::Beam& beam, EndOfWalk end);
  void trace_ray(const CrossingRay& ray);
  void see_to_samples();
  void require_own(std::uint32_t cell) const;
  void settle(std::uint32_t sample, const accel::Hit& best);
  accel::Hit global(const std::optional<accel::Hit>& local) const;
  accel::octree::OctreeCursor cell_cursor(std::uint32_t cell) const;
  accel::Ray ray_of(std::uint32_t sample) const;

  ScenePart part_;
  const SceneSplit* split_;
  ProcessId self_;
  const accel::PrimaryRays* rays_;
  BorderPost* post_;
  accel::beam::BeamTracer tracer_;
  ForeignLeaves foreign_;
  accel::beam::EyeView view_;
  accel::beam::WholeImage sight_;
  accel::HitBuffer found_here_;  ///< by this scene's ids, while a beam is being traced
  accel::HitBuffer found_;       ///< by the whole scene's
  BorderWatch watch_;
  accel::beam::BeamPainter<BorderWatch, accel::beam::WholeImage> painter_;
  double samples_;
  bool beginning_ = true;
  accel::beam::BeamQueue queue_;
  std::optional<accel::beam::BeamStep> next_;  ///< of the queue, taken off
  std::deque<CrossingBeam> entering_;
  std::deque<CrossingRay> waiting_;
};

}  // namespace beambench::cluster
