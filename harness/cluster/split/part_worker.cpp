#include "harness/cluster/split/part_worker.hpp"

#include <utility>

#include "scenes/core/error.hpp"

namespace beambench::cluster {
namespace {

constexpr accel::Hit kNothing{accel::kInfinity, scenes::kNoPrimitive};

accel::octree::OctreePart own_cells(const SceneSplit& split, ProcessId self) {
  return {split.level(), [&split, self](const glm::ivec3& cell) {
            return split.owner(split.index(cell)) == self;
          }};
}

accel::beam::BeamOptions checked(const accel::beam::BeamOptions& options, const SceneSplit& split) {
  if (!options.continue_with_rays || options.share_corners) {
    throw InputError(
        "a divided scene needs continue=rays and share_corners=false, which are the defaults");
  }
  if (options.octree.max_level < split.level()) {
    throw InputError(
        "the cells of --split are deeper than max_level; choose a fixed max_level that is not "
        "less than the level of the cells");
  }
  return options;
}

}  // namespace

ForeignLeaves::ForeignLeaves(const accel::octree::Octree& octree, const SceneSplit& split,
                             ProcessId self)
    : cells_(octree.nodes().size(), kOwn) {
  const std::int32_t finest = octree.grid().cells.x / split.cells();
  for (std::uint32_t cell = 0; cell < split.cell_count(); ++cell) {
    if (split.owner(cell) == self) continue;
    cells_[accel::octree::cursor_of(octree, split.cell(cell) * finest, finest).index()] = cell;
  }
}

PartWorker::PartWorker(ScenePart part, const SceneSplit& split, ProcessId self,
                       const accel::beam::BeamOptions& options, const accel::PrimaryRays& rays,
                       HandoffSink& post)
    : part_(std::move(part)),
      split_(&split),
      self_(self),
      rays_(&rays),
      sink_(&post),
      tracer_(part_.scene,
              accel::octree::Octree(part_.scene, checked(options, split).octree,
                                    own_cells(split, self)),
              options),
      foreign_(tracer_.octree(), split, self),
      view_(tracer_.octree().grid(), rays),
      found_here_(rays.width(), rays.height(), rays.samples()),
      found_(rays.width(), rays.height(), rays.samples()),
      watch_(tracer_.octree(), foreign_),
      painter_(part_.scene, tracer_, tracer_.options(), view_, rays, sight_, found_here_, {},
               watch_),
      samples_(static_cast<double>(rays.count())) {
  queue_.border = this;
  accel::beam::begin_beams(tracer_.octree(), view_, view_.screen(), queue_);
  beginning_ = false;
}

void PartWorker::take(const BeamHandoff& beam) {
  require_own(beam.cell);
  entering_.push_back(beam);
}

void PartWorker::take(const RayHandoff& ray) {
  require_own(ray.cell);
  if (ray.sample >= found_.size()) throw ProtocolError("a ray of a sample outside of the image");
  waiting_.push_back(ray);
}

PartWork PartWorker::work() {
  if (!waiting_.empty()) {
    trace_rays();
    return PartWork::kTesting;
  }
  std::size_t walked = 0;
  for (; walked < kBeamsAtOnce && (!entering_.empty() || has_next()); ++walked) {
    if (!entering_.empty()) {
      const BeamHandoff& beam = entering_.front();
      accel::beam::enter_node(view_, beam.face, cell_cursor(beam.cell), beam.beam, queue_);
      entering_.pop_front();
    } else if (const auto end = end_of_walk(*next_)) {
      if (walked > 0) break;
      test(next_->beam, *end);
      next_.reset();
      return PartWork::kTesting;
    } else {
      walk(*next_);
      next_.reset();
    }
  }
  return walked > 0 ? PartWork::kWalking : PartWork::kNone;
}

/// Fills `next_` if there is a beam.
bool PartWorker::has_next() {
  if (next_) return true;
  if (queue_.waiting.empty()) return false;
  queue_.waiting.pop(next_.emplace());
  return true;
}

void PartWorker::trace_rays() {
  for (std::size_t i = 0; i < kRaysAtOnce && !waiting_.empty(); ++i) {
    const RayHandoff ray = waiting_.front();
    waiting_.pop_front();
    trace_ray(ray);
  }
}

/// A beam that begins in a foreign leaf is begun by its owner.
bool PartWorker::takes(std::uint32_t leaf, const accel::beam::Crossing& face,
                       const accel::beam::Beam& beam) {
  const auto cell = foreign_.cell_at(leaf);
  if (cell && !beginning_) sink_->hand_over(BeamHandoff{*cell, face, beam});
  return cell.has_value();
}

/// The reason for which a beam ends here; nothing where it continues.
std::optional<PartWorker::EndOfWalk> PartWorker::end_of_walk(
    const accel::beam::BeamStep& step) const {
  if (step.kind == accel::BeamKind::kLeaving || is_foreign(step.beam)) return std::nullopt;
  if (step.kind == accel::BeamKind::kOccupied) return EndOfWalk::kOccupied;
  if (step.beam.crowded()) return EndOfWalk::kCrowded;
  const auto handover = static_cast<double>(tracer_.options().handover);
  if (handover > 0.0 && accel::beam::area(step.beam.outline) * samples_ < handover)
    return EndOfWalk::kHandover;
  return std::nullopt;
}

void PartWorker::walk(const accel::beam::BeamStep& step) {
  if (step.kind == accel::BeamKind::kLeaving || is_foreign(step.beam)) return;
  accel::beam::continue_beam(tracer_.octree(), view_, step.beam, queue_);
}

void PartWorker::test(const accel::beam::Beam& beam, EndOfWalk end) {
  if (end == EndOfWalk::kOccupied) {
    painter_.test_leaf(beam);
  } else {
    painter_.hand_over(beam, end == EndOfWalk::kCrowded ? accel::beam::RayReason::kCrowded
                                                        : accel::beam::RayReason::kHandover);
  }
  collect_samples();
}

void PartWorker::collect_samples() {
  for (const std::uint32_t sample : watch_.decided) {
    decide(sample, global(found_here_.get(sample)));
  }
  for (const BorderWatch::Crossed& each : watch_.crossed) {
    const accel::Hit best = global(found_here_.get(each.sample));
    sink_->hand_over(RayHandoff{each.cell, each.sample, each.t, best.t, best.primitive});
  }
  watch_.decided.clear();
  watch_.crossed.clear();
}

/// Continues where the ray entered. Its best hit so far limits the search: nothing farther is kept,
/// and an equal t is compared by the whole scene's ids.
void PartWorker::trace_ray(const RayHandoff& crossing) {
  const accel::Ray ray = ray_of(crossing.sample);
  const accel::CellRay way(tracer_.octree().grid(), ray);
  accel::ClosestHit closest(ray);
  closest.ray.t_max = crossing.best_t;
  accel::NoCounting none;
  std::optional<RayHandoff> next;
  double t = crossing.t;
  const accel::octree::OctreeNode* nodes = tracer_.octree().nodes().data();
  accel::octree::LeafWalk{tracer_.octree(), tracer_.neighbors(), ray, way}.from(
      cell_cursor(crossing.cell), t, 0, none,
      [&](const accel::octree::OctreeNode& leaf, double exit_t) {
        if (const auto cell = foreign_.cell_at(static_cast<std::uint32_t>(&leaf - nodes))) {
          next = RayHandoff{*cell, crossing.sample, t, 0.0F, 0};
          return true;
        }
        t = exit_t;
        return accel::test_references(part_.scene, tracer_.octree().references(leaf), exit_t, none,
                                      closest);
      });
  accel::Hit best{crossing.best_t, crossing.best};
  if (const accel::Hit here = global(closest.result()); accel::precedes(here, best)) best = here;
  if (!next) return decide(crossing.sample, best);
  next->best_t = best.t;
  next->best = best.primitive;
  sink_->hand_over(*next);
}

void PartWorker::decide(std::uint32_t sample, const accel::Hit& best) {
  if (best.primitive != scenes::kNoPrimitive) found_.set(sample, best);
}

accel::Hit PartWorker::global(const std::optional<accel::Hit>& local) const {
  if (!local) return kNothing;
  return {local->t, part_.global[local->primitive]};
}

void PartWorker::require_own(std::uint32_t cell) const {
  if (cell >= split_->cell_count() || split_->owner(cell) != self_) {
    throw ProtocolError("a handoff for a cell of another process");
  }
}

accel::octree::OctreeCursor PartWorker::cell_cursor(std::uint32_t cell) const {
  const std::int32_t finest = tracer_.octree().grid().cells.x / split_->cells();
  return accel::octree::cursor_of(tracer_.octree(), split_->cell(cell) * finest, finest);
}

accel::Ray PartWorker::ray_of(std::uint32_t sample) const {
  const auto each = static_cast<std::uint32_t>(rays_->samples());
  const auto width = static_cast<std::uint32_t>(rays_->width());
  const std::uint32_t pixel = sample / each;
  return rays_->ray(static_cast<int>(pixel % width), static_cast<int>(pixel / width),
                    static_cast<int>(sample % each));
}

std::vector<std::uint32_t> PartWorker::hit_samples() const {
  std::vector<std::uint32_t> samples;
  for (std::size_t i = 0; i < found_.size(); ++i) {
    if (found_.primitive()[i] != scenes::kNoPrimitive)
      samples.push_back(static_cast<std::uint32_t>(i));
  }
  return samples;
}

std::uint64_t PartWorker::structure_bytes() const {
  return tracer_.statistics().bytes + foreign_.memory_bytes();
}

}  // namespace beambench::cluster
