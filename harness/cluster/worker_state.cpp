#include "harness/cluster/worker_state.hpp"

#include <array>

#include <fmt/format.h>
#include <unistd.h>

#include "accel/core/registry.hpp"
#include "harness/base/stopwatch.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/core/error.hpp"

namespace beambench::cluster {

WorkerState::WorkerState(const Job& job, std::vector<std::string>* warnings)
    : scene_(scenes::load_scene(job.scene, warnings)) {
  const rays::ImageOfRays image = job_image(job, scene_);
  rays_.emplace(image.camera, image.resolution.width, image.resolution.height, image.samples);
  const accel::StructureChoice choice = accel::registry().choose(parse_spec(job.structure));
  const base::CpuStopwatch timer;
  structure_ = choice.build(scene_, rays::workload_of(image, *rays_));
  build_seconds_ = timer.seconds();
  tracer_ = dynamic_cast<const accel::beam::BeamTracer*>(structure_.get());
  if (tracer_ == nullptr) {
    throw InputError(
        fmt::format("{} traces no beams to distribute; the cluster needs 'beam', with or without "
                    "parameters",
                    choice.info().name));
  }
  if (job.light) light_.emplace(scene_, *structure_, job.whitted, rays::HitCheck(scene_, choice));
}

Identity WorkerState::identity() const {
  const accel::octree::Octree& octree = tracer_->octree();
  return {visible_hash(scene_), scene_.primitives.size(), octree.nodes().size(),
          octree.reference_count()};
}

ReadyReport WorkerState::ready_report() const {
  return {host_name(), "", identity(), build_seconds_, structure_->statistics().bytes};
}

std::string host_name() {
  std::array<char, 256> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0) return "unnamed machine";
  return name.data();
}

}  // namespace beambench::cluster
