#pragma once
// What every process makes for itself: the scene, its octree, the rays.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "accel/beam/beam_tracer.hpp"
#include "harness/cluster/job.hpp"
#include "harness/render/whitted.hpp"

namespace beambench::cluster {

class Studio {
 public:
  /// Loads and builds. Throws InputError where that cannot be done, or the structure is not `beam`.
  /// What the scene's reader noticed is appended to `warnings` when given.
  explicit Studio(const Job& job, std::vector<std::string>* warnings = nullptr);
  Studio(const Studio&) = delete;
  Studio& operator=(const Studio&) = delete;
  ~Studio() = default;

  const scenes::Scene& scene() const { return scene_; }
  const accel::beam::BeamTracer& tracer() const { return *tracer_; }
  const accel::PrimaryRays& rays() const { return *rays_; }
  /// Nothing where the job wants hits alone.
  const render::Whitted* light() const { return light_ ? &*light_ : nullptr; }

  Identity identity() const;
  /// Of this process, when all is built.
  Introduction introduction() const;

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
