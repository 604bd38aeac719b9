#pragma once
// Traces one process's part of a scene.

#include <cstdint>
#include <deque>
#include <optional>
#include <variant>
#include <vector>

#include "accel/beam/beam.hpp"
#include "accel/beam/beam_painter.hpp"
#include "accel/beam/beam_tracer.hpp"
#include "harness/thesis/cluster/messages.hpp"
#include "harness/thesis/cluster/report.hpp"
#include "harness/thesis/cluster/split/part_tracer.hpp"
#include "harness/thesis/cluster/split/scene_split.hpp"
#include "harness/thesis/cluster/tasks.hpp"

namespace beambench::cluster {

/// A beam that enters another process's cell through a face. Its `node`, `corner` and `size` are
/// meaningless in the other process.
struct BeamHandoff {
  std::uint32_t cell;
  accel::beam::Crossing face;
  accel::beam::Beam beam;
};

/// A ray that enters another process's cell, with its best hit so far.
struct RayHandoff {
  std::uint32_t cell;
  std::uint32_t sample;      ///< its index in the hit buffer
  double t;                  ///< the t at which it enters
  float best_t;              ///< infinity for a miss
  scenes::PrimitiveId best;  ///< in the whole scene
};

using Handoff = std::variant<BeamHandoff, RayHandoff>;

void write_handoff(const BeamHandoff& beam, Bytes& bytes);
void write_handoff(const RayHandoff& ray, Bytes& bytes);

/// Reads the next handoff of a message. Throws ProtocolError for other bytes.
Handoff read_handoff(ByteReader& reader, const accel::beam::EyeView& view);

/// Collects handoffs into messages, with one open message for each process.
class Outbox {
 public:
  Outbox(Transport& transport, const SceneSplit& split);
  void hand_over(const BeamHandoff& beam);
  void hand_over(const RayHandoff& ray);

  /// The size above which it pays to send a message early, so that its recipient can begin while
  /// this process still works.
  static constexpr std::size_t kLarge = 1 << 11;
  /// Sends the messages of at least `least` bytes; by default, all nonempty ones.
  void send(std::size_t least = 1);

  const Traffic& sent() const { return sent_; }
  std::uint64_t beams() const { return beams_; }
  std::uint64_t rays() const { return rays_; }

 private:
  Transport* transport_;
  const SceneSplit* split_;
  std::vector<Bytes> open_;  ///< by process
  Traffic sent_;
  std::uint64_t beams_ = 0;
  std::uint64_t rays_ = 0;
};

/// Records the samples decided by beams, and those that continue as rays into a foreign leaf.
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

/// A kind of work.
enum class PartWork {
  kNone,
  kWalking,  ///< traversal of beams through empty leaves
  kTesting,  ///< samples in occupied leaves, and the rays behind them
  kTaking,   ///< receiving handoffs
};

/// The beam tracer over a part of a scene. Beams and rays that reach the border are passed on to
/// other processes, rays with their best hit. Beams and rays from other processes continue here.
/// Together, the processes find the same hits as one process with the whole scene, bit for bit:
/// beams are divided by the same planes, a primitive is tested in every cell that it overlaps, and
/// at equal t the lowest id of the whole scene wins.
class PartWorker : private accel::beam::BeamBorder {
 public:
  /// Starts the beams that begin in this part. Rays and outbox must outlive the worker. Throws
  /// InputError for options that a divided scene does not support.
  PartWorker(ScenePart part, const SceneSplit& split, ProcessId self,
             const accel::beam::BeamOptions& options, const accel::PrimaryRays& rays,
             Outbox& outbox);
  PartWorker(const PartWorker&) = delete;
  PartWorker& operator=(const PartWorker&) = delete;
  ~PartWorker() override = default;

  /// Queues a handoff. Throws ProtocolError if its cell belongs to another process.
  void take(const BeamHandoff& beam);
  void take(const RayHandoff& ray);

  /// Does some of the queued work, if any, and returns its kind.
  PartWork work();

  /// Returns the samples with a hit in this part, ascending, and their hits.
  std::vector<std::uint32_t> hit_samples() const;
  const accel::HitBuffer& hits() const { return found_; }

  /// Returns the tracer for rays that do not come from the eye.
  const PartTracer& single_rays() const { return single_rays_; }

  const accel::beam::EyeView& view() const { return view_; }
  const scenes::Scene& scene() const { return part_.scene; }
  std::uint64_t structure_bytes() const;
  /// Returns the statistics of the part's octree.
  accel::Statistics statistics() const { return tracer_.statistics(); }

 private:
  /// The number of rays and beams traced between two polls for messages.
  static constexpr std::size_t kRaysAtOnce = 256;
  static constexpr std::size_t kBeamsAtOnce = 32;

  bool takes(std::uint32_t leaf, const accel::beam::Crossing& face,
             const accel::beam::Beam& beam) override;
  void keep_own_beams();
  void walk();
  void paint_ended();
  void trace_ray(const RayHandoff& ray);
  void collect_samples();
  void require_own(std::uint32_t cell) const;
  void decide(std::uint32_t sample, const accel::Hit& best);

  ScenePart part_;
  const SceneSplit* split_;
  ProcessId self_;
  const accel::PrimaryRays* rays_;
  Outbox* outbox_;
  accel::beam::BeamTracer tracer_;
  ForeignLeaves foreign_;
  PartTracer single_rays_;
  accel::beam::EyeView view_;
  accel::beam::WholeImage sight_;
  accel::HitBuffer found_here_;  ///< ids of this part, while a beam is traced
  accel::HitBuffer found_;       ///< ids of the whole scene
  BorderWatch watch_;
  accel::beam::BeamPainter<BorderWatch, accel::beam::WholeImage> painter_;
  accel::beam::BeamQueue queue_;
  accel::beam::BeamStack ended_;  ///< ended beams, whose samples must be traced
  std::deque<BeamHandoff> entering_;
  std::deque<RayHandoff> waiting_;
};

}  // namespace beambench::cluster
