#pragma once
// What every process builds for itself: the scene, its octree, the rays.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "accel/beam/beam_tracer.hpp"
#include "harness/cluster/job.hpp"
#include "harness/render/whitted.hpp"

namespace beambench::cluster {

class WorkerState {
 public:
  /// Loads and builds. Throws InputError if that fails or the structure is not `beam`. Warnings of
  /// the scene's reader are appended to `warnings` if given.
  explicit WorkerState(const Job& job, std::vector<std::string>* warnings = nullptr);
  WorkerState(const WorkerState&) = delete;
  WorkerState& operator=(const WorkerState&) = delete;
  ~WorkerState() = default;

  const scenes::Scene& scene() const { return scene_; }
  const accel::beam::BeamTracer& tracer() const { return *tracer_; }
  const accel::PrimaryRays& rays() const { return *rays_; }
  /// Null if the job is for hits alone.
  const render::Whitted* light() const { return light_ ? &*light_ : nullptr; }

  Identity identity() const;
  /// Of this process, once all is built.
  ReadyReport ready_report() const;

 private:
  scenes::Scene scene_;
  std::unique_ptr<accel::Accelerator> structure_;
  const accel::beam::BeamTracer* tracer_ = nullptr;
  std::optional<accel::PrimaryRays> rays_;
  std::optional<render::Whitted> light_;
  double build_seconds_ = 0.0;
};

/// This machine's name.
std::string host_name();

}  // namespace beambench::cluster
