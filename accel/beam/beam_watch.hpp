#pragma once
// Reports a beam tracer's actions to a compile-time policy, in addition to the rays' policy.

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "accel/beam/beam.hpp"
#include "accel/beam/beam_paths.hpp"
#include "accel/beam/sample_lattice.hpp"
#include "accel/core/work_counters.hpp"

namespace beambench::accel::beam {

/// The reason why a sample became an individual ray.
enum class RayReason {
  kOccupied,  ///< no hit nearer than the exit of the occupied leaf where its beam ended
  kHandover,  ///< its beam had fewer samples than `handover`
  kCrowded    ///< its beam had too many cuts to be divided (never observed)
};

/// The policy of timed code. A tracer reports to its policy
/// - each beam and what it enters, before it is processed (`met`),
/// - each sample when its beam has decided it or turned it into a ray (`painted`: its places in the
///   hit buffer; samples of leaving beams only if `kPaintsLeaving`, since the buffer already holds
///   the background),
/// - how many samples left the root (`left`) or were tested in a leaf (`tested`) with a beam, and
///   each that continues as a ray (`handed_over`),
/// - that no beam is being processed until the next is met (`resting`),
/// - each leaf that a single ray enters, at t (`leaves_part`); if the leaf belongs to another
///   process, the ray ends there, and `painted` follows with the best hit so far,
/// - at the end, the work of dividing beams (`divided`) and the end itself (`finished`). The policy
///   supplies the policy of individual rays (`rays`) and the samples to trace in the current beam
///   (`chosen`).
struct NoBeamWatch {
  static constexpr bool kPaintsLeaving = false;
  static std::span<const SampleLattice> chosen(std::span<const SampleLattice> all) { return all; }
  static constexpr void met(BeamKind, const Beam&) {}
  static constexpr void painted(std::size_t) {}
  static constexpr void left(std::uint64_t) {}
  static constexpr void tested(std::uint64_t) {}
  static constexpr void handed_over(RayReason) {}
  static constexpr void resting() {}
  static constexpr bool leaves_part(const octree::OctreeNode&, double) { return false; }
  static constexpr void divided(const BeamQueue&) {}
  static constexpr void finished() {}
  NoCounting rays() const { return {}; }
};

/// Keeps each beam: its outline in pixels, its leaf and its samples.
class OutlineBeamWatch : public NoBeamWatch {
 public:
  OutlineBeamWatch(int width, int height) : pixels_(width, height) {}

  void met(BeamKind kind, const Beam& beam) {
    BeamOutline& outline = outlines_.emplace_back(BeamOutline{kind, {}, beam.node});
    for (const glm::dvec2& corner : beam.outline) outline.corners.push_back(corner * pixels_);
  }
  void painted(std::size_t place) { outlines_.back().samples.push_back(place); }
  /// Sorts each beam's samples: beams report them lattice by lattice, hits first.
  void finished() {
    for (BeamOutline& outline : outlines_) std::ranges::sort(outline.samples);
  }
  std::vector<BeamOutline> take() && { return std::move(outlines_); }

 private:
  glm::dvec2 pixels_;
  std::vector<BeamOutline> outlines_;
};

/// Counts beams, their edges, divisions and samples, and the time spent on each kind of beam
/// (thesis, section 5.3.3).
class CountingBeamWatch {
 public:
  static constexpr bool kPaintsLeaving = true;
  static std::span<const SampleLattice> chosen(std::span<const SampleLattice> all) { return all; }

  explicit CountingBeamWatch(WorkCounters& counters) : counters_(&counters) {}

  void met(BeamKind kind, const Beam& beam) {
    stop_clock();
    task_ = &times_[static_cast<std::size_t>(kind)];
    ++kinds_[static_cast<std::size_t>(kind)];
    edges_ += beam.outline.size();
  }
  static constexpr void painted(std::size_t) {}
  /// Counts the samples of a leaving beam.
  void left(std::uint64_t samples) { left_ += samples; }
  void tested(std::uint64_t samples) { tested_ += samples; }
  static constexpr bool leaves_part(const octree::OctreeNode&, double) { return false; }
  void handed_over(RayReason reason) { ++reasons_[static_cast<std::size_t>(reason)]; }
  void resting() {
    stop_clock();
    task_ = nullptr;
  }
  void divided(const BeamQueue& queue) {
    clips_ += queue.clips;
    neighbor_searches_ += queue.neighbor_searches;
    made_ += queue.made;
    divided_ += queue.divided;
    passed_whole_ += queue.passed_whole;
  }
  /// Adds the sums to the counters when the image is done.
  void finished();
  WorkCounters& rays() const { return *counters_; }

 private:
  using Clock = std::chrono::steady_clock;

  void stop_clock() {
    const auto now = Clock::now();
    if (task_ != nullptr) *task_ += now - since_;
    since_ = now;
  }

  WorkCounters* counters_;
  std::array<std::uint64_t, 3> kinds_{};
  std::array<Clock::duration, 3> times_{};
  std::array<std::uint64_t, 3> reasons_{};
  std::uint64_t edges_ = 0;
  std::uint64_t clips_ = 0;
  std::uint64_t neighbor_searches_ = 0;
  std::uint64_t made_ = 0;
  std::uint64_t divided_ = 0;
  std::uint64_t passed_whole_ = 0;
  std::uint64_t left_ = 0;
  std::uint64_t tested_ = 0;
  Clock::duration* task_ = nullptr;
  Clock::time_point since_;
};

}  // namespace beambench::accel::beam
