#include "accel/core/moved_structure.hpp"

#include <utility>

#include <fmt/format.h>

namespace beambench::accel {
namespace {

const scenes::Scene& below(const MovingStructure& structure) {
  return structure.moving ? *structure.moving : *structure.target;
}

}  // namespace

std::unique_ptr<scenes::Scene> copy_first_frame(const scenes::Scene& scene) {
  return scene.first_frame ? std::make_unique<scenes::Scene>(*scene.first_frame) : nullptr;
}

MovedStructure::MovedStructure(const StructureChoice& choice, const scenes::Scene& scene,
                               std::unique_ptr<scenes::Scene> moving, const Workload& workload)
    : MovingStructure{&scene, std::move(moving), nullptr},
      ForwardingAccelerator(
          *(built = choice.info().build(below(*this), choice.parameters(), workload))) {}

void MovedStructure::place() {
  if (moving) set_pose(*moving, scenes::pose_of(*target), target->frame);
}

void MovedStructure::describe(TreeQuality& tree) const {
  if (const auto* hierarchy = dynamic_cast<const BoxHierarchy*>(built.get())) {
    hierarchy->describe(tree);
  }
}

void MovedStructure::update() {
  if (built->update(below(*this))) return;
  throw UnsupportedError(
      fmt::format("the structure cannot be updated from the first frame of {}; it must be rebuilt",
                  target->name));
}

}  // namespace beambench::accel
