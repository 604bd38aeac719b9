#include "harness/bench/task.hpp"

#include "harness/bench/picture_task.hpp"
#include "harness/bench/rays_task.hpp"

namespace beambench::bench {

HarnessShare Task::harness_share(const accel::Accelerator& structure) {
  const QueryPath path = path_of(structure);
  if (path == QueryPath::kImageOwn) return {path, 0.0};
  const auto [entry, is_new] = harness_ms_.try_emplace(path);
  if (is_new) entry->second = measure_harness_ms(path);
  return {path, entry->second};
}

std::unique_ptr<Task> make_task(const CellGroup& group, std::uint64_t scene_hash, int core) {
  if (group.rays.kind == rays::RayKind::kWhitted) {
    return std::make_unique<PictureTask>(group, scene_hash, core);
  }
  return std::make_unique<RaysTask>(group, scene_hash, core);
}

}  // namespace beambench::bench
