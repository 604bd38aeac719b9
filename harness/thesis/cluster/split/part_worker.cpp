#include "harness/thesis/cluster/split/part_worker.hpp"

#include <concepts>
#include <tuple>
#include <type_traits>
#include <utility>

#include "harness/rays/trace_input.hpp"
#include "scenes/base/error.hpp"

namespace beambench::cluster {
namespace {

enum class Kind : std::uint8_t { kBeam, kRay };

template <class Ray>
auto members(Ray& ray) requires std::same_as<std::remove_const_t<Ray>, RayHandoff> {
  return std::tie(ray.cell, ray.sample, ray.t, ray.best_t, ray.best);
}

/// Returns the side of a cell, in units of the octree's finest cells.
std::int32_t cell_size(const accel::octree::Octree& octree, const SceneSplit& split) {
  return octree.grid().cells.x / split.cells().along();
}

accel::beam::BeamOptions checked(const accel::beam::BeamOptions& options, const SceneSplit& split) {
  if (!options.continue_with_rays || options.share_corners) {
    throw InputError(
        "a divided scene requires continue=rays and share_corners=false, which are the defaults");
  }
  if (options.octree.max_level < split.cells().level()) {
    throw InputError(
        "the cells of --split are deeper than max_level; choose a fixed max_level of at least the "
        "level of the cells");
  }
  return options;
}

}  // namespace

void write_handoff(const BeamHandoff& beam, Bytes& bytes) {
  ByteWriter writer(bytes);
  writer.put(Kind::kBeam);
  writer.put(beam.cell);
  write_crossing(beam.face, writer);
  write_shape(beam.beam, writer);
}

void write_handoff(const RayHandoff& ray, Bytes& bytes) {
  ByteWriter writer(bytes);
  writer.put(Kind::kRay);
  writer.put(members(ray));
}

Handoff read_handoff(ByteReader& reader, const accel::beam::EyeView& view) {
  switch (reader.get<Kind>()) {
    case Kind::kBeam: {
      BeamHandoff beam{};
      beam.cell = reader.get<std::uint32_t>();
      beam.face = read_crossing(view.grid(), reader);
      read_shape(reader, view, beam.beam);
      return beam;
    }
    case Kind::kRay: {
      RayHandoff ray{};
      reader.get(members(ray));
      return ray;
    }
  }
  throw ProtocolError("a handoff is neither a beam nor a ray");
}

Outbox::Outbox(Transport& transport, const SceneSplit& split)
    : transport_(&transport),
      split_(&split),
      open_(static_cast<std::size_t>(transport.processes())) {}

void Outbox::hand_over(const BeamHandoff& beam) {
  write_handoff(beam, open_[static_cast<std::size_t>(split_->owner(beam.cell))]);
  ++beams_;
}

void Outbox::hand_over(const RayHandoff& ray) {
  write_handoff(ray, open_[static_cast<std::size_t>(split_->owner(ray.cell))]);
  ++rays_;
}

void Outbox::send(std::size_t least) {
  for (std::size_t i = 0; i < open_.size(); ++i) {
    if (open_[i].size() < least) continue;
    sent_.add(open_[i].size());
    transport_->send(static_cast<ProcessId>(i), Tag::kCross, std::exchange(open_[i], {}));
  }
}

PartWorker::PartWorker(ScenePart part, const SceneSplit& split, ProcessId self,
                       const accel::beam::BeamOptions& options, const accel::PrimaryRays& rays,
                       Outbox& outbox)
    : part_(std::move(part)),
      split_(&split),
      self_(self),
      rays_(&rays),
      outbox_(&outbox),
      tracer_(part_.scene,
              accel::octree::Octree(part_.scene, checked(options, split).octree,
                                    own_cells(split, self)),
              options),
      foreign_(tracer_.octree(), split, self),
      single_rays_(part_, tracer_, split, foreign_),
      view_(tracer_.octree().grid(), rays),
      found_here_(rays.width(), rays.height(), rays.samples()),
      found_(rays.width(), rays.height(), rays.samples()),
      watch_(tracer_.octree(), foreign_),
      painter_(part_.scene, tracer_, tracer_.options(), view_, rays, sight_, found_here_, {},
               watch_) {
  accel::beam::begin_beams(tracer_.octree(), view_, view_.screen(), queue_);
  keep_own_beams();
  queue_.border = this;
}

/// Keeps the beams of this part. Each beam is started by the owner of the cell in which it begins.
void PartWorker::keep_own_beams() {
  accel::beam::BeamStack begun;
  accel::beam::BeamStep step;
  while (!queue_.waiting.empty()) {
    queue_.waiting.pop(step);
    const glm::ivec3 cell = step.beam.corner / cell_size(tracer_.octree(), *split_);
    if (split_->owner(split_->cells().index(cell)) == self_) begun.push(step.kind, step.beam);
  }
  queue_.waiting = std::move(begun);
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

/// Processes beams before rays, because beams create work for other processes.
PartWork PartWorker::work() {
  if (!entering_.empty() || !queue_.waiting.empty()) {
    walk();
    return PartWork::kWalking;
  }
  if (!ended_.empty()) {
    paint_ended();
    return PartWork::kTesting;
  }
  if (waiting_.empty()) return PartWork::kNone;
  for (std::size_t i = 0; i < kRaysAtOnce && !waiting_.empty(); ++i) {
    const RayHandoff ray = waiting_.front();
    waiting_.pop_front();
    trace_ray(ray);
  }
  return PartWork::kTesting;
}

void PartWorker::walk() {
  accel::beam::BeamStep step;
  for (std::size_t walked = 0; walked < kBeamsAtOnce; ++walked) {
    if (!entering_.empty()) {
      const BeamHandoff& beam = entering_.front();
      accel::beam::enter_node(view_, beam.face,
                              cursor_of_cell(tracer_.octree(), *split_, beam.cell), beam.beam,
                              queue_);
      entering_.pop_front();
      continue;
    }
    if (queue_.waiting.empty()) return;
    queue_.waiting.pop(step);
    if (step.kind == accel::BeamKind::kLeaving) continue;
    if (end_of(step, tracer_, *rays_)) {
      ended_.push(step.kind, step.beam);
    } else {
      accel::beam::continue_beam(tracer_.octree(), view_, step.beam, queue_);
    }
  }
}

void PartWorker::paint_ended() {
  accel::beam::BeamStep step;
  ended_.pop(step);
  if (const auto end = end_of(step, tracer_, *rays_)) paint(*end, step.beam, painter_);
  collect_samples();
}

bool PartWorker::takes(std::uint32_t leaf, const accel::beam::Crossing& face,
                       const accel::beam::Beam& beam) {
  const auto cell = foreign_.cell_at(leaf);
  if (cell) outbox_->hand_over(BeamHandoff{*cell, face, beam});
  return cell.has_value();
}

void PartWorker::collect_samples() {
  for (const std::uint32_t sample : watch_.decided) {
    decide(sample, single_rays_.global(found_here_.get(sample)));
  }
  for (const BorderWatch::Crossed& each : watch_.crossed) {
    const accel::Hit best = single_rays_.global(found_here_.get(each.sample));
    outbox_->hand_over(RayHandoff{each.cell, each.sample, each.t, best.t, best.primitive});
  }
  watch_.decided.clear();
  watch_.crossed.clear();
}

/// Continues a ray from where it entered this part.
void PartWorker::trace_ray(const RayHandoff& crossing) {
  const PartTracer::Passage passage = single_rays_.closest(
      rays::ray_at(*rays_, crossing.sample), single_rays_.entry(crossing.cell, crossing.t),
      {crossing.best_t, crossing.best});
  const auto& [best, exit] = passage;
  if (!exit) return decide(crossing.sample, best);
  outbox_->hand_over(RayHandoff{exit->cell, crossing.sample, exit->t, best.t, best.primitive});
}

void PartWorker::decide(std::uint32_t sample, const accel::Hit& best) {
  if (best.primitive != scenes::kNoPrimitive) found_.set(sample, best);
}

void PartWorker::require_own(std::uint32_t cell) const {
  if (cell >= split_->cells().count() || split_->owner(cell) != self_) {
    throw ProtocolError("a handoff for a cell of another process");
  }
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
