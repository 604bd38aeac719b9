#include "harness/sweep/task.hpp"

#include "harness/sweep/picture_task.hpp"
#include "harness/sweep/rays_task.hpp"

namespace beambench {

std::unique_ptr<Task> make_task(const CellGroup& group, std::uint64_t scene_hash, int core) {
  if (group.rays.kind == RayKind::kWhitted) {
    return std::make_unique<PictureTask>(group, scene_hash, core);
  }
  return std::make_unique<RaysTask>(group, scene_hash, core);
}

}  // namespace beambench
