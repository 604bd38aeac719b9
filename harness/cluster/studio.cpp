#include "harness/cluster/studio.hpp"

#include <array>

#include <fmt/format.h>
#include <unistd.h>

#include "accel/core/registry.hpp"
#include "harness/base/stopwatch.hpp"
#include "harness/cli/inputs.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/core/error.hpp"

namespace beambench::cluster {

Studio::Studio(const Job& job, std::vector<std::string>* warnings)
    : scene_(scenes::load_scene(job.scene, warnings)) {
  const rays::ImageOfRays image = job_image(job, scene_);
  rays_.emplace(image.camera, image.resolution.width, image.resolution.height, image.samples);
  const accel::StructureChoice choice = cli::choose_one("--accel", job.structure);
  const base::CpuStopwatch timer;
  structure_ = choice.build(scene_, rays::workload_of(image, *rays_));
  build_seconds_ = timer.seconds();
  tracer_ = dynamic_cast<const accel::beam::BeamTracer*>(structure_.get());
  if (tracer_ == nullptr) {
    throw InputError(
        fmt::format("--accel {} has no beams to share out; the cluster traces with "
                    "'beam' and its parameters",
                    choice.info().name));
  }
  if (job.light) light_.emplace(scene_, *structure_, job.whitted, rays::HitCheck(scene_, choice));
}

Identity Studio::identity() const {
  const accel::octree::Octree& octree = tracer_->octree();
  return {look_hash(scene_), octree.nodes().size(), octree.reference_count()};
}

Introduction Studio::introduction() const {
  return {host_name(), "", identity(), build_seconds_, structure_->statistics().bytes};
}

std::string host_name() {
  std::array<char, 256> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0) return "a nameless machine";
  return name.data();
}

}  // namespace beambench::cluster
