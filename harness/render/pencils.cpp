#include "harness/render/pencils.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace beambench::render {

PlaneGroups::PlaneGroups(Turn turn, const rays::PlaneTable& planes, std::span<const Eye> eyes)
    : turn_(turn), planes_(&planes), before_(eyes) {
  if (planes.planes().empty() || eyes.empty()) return;
  groups_.push_back({kNoKey});
  slots_.resize(64);
}

std::uint32_t PlaneGroups::group_with(std::uint64_t key) {
  if (key == kNoKey) return 0;
  std::uint32_t& slot = slot_of(key);
  if (slot != 0) return slot;
  const auto group = static_cast<std::uint32_t>(groups_.size());
  slot = group;
  groups_.push_back({key});
  if (2 * groups_.size() > slots_.size()) {
    slots_.assign(2 * slots_.size(), 0);
    for (std::uint32_t i = 1; i < groups_.size(); ++i) slot_of(groups_[i].key) = i;
  }
  return group;
}

/// Returns the slot of the group with a key, whether or not it is listed yet.
std::uint32_t& PlaneGroups::slot_of(std::uint64_t key) {
  std::size_t slot = (key * 0x9E3779B97F4A7C15U) >> 32U;  // Fibonacci hashing
  do {
    slot = (slot + 1) & (slots_.size() - 1);
  } while (slots_[slot] != 0 && groups_[slots_[slot]].key != key);
  return slots_[slot];
}

/// Gives each group with enough rays an eye, and determines the places of all groups.
void PlaneGroups::mark_groups() {
  for (const Run& run : runs_) groups_[run.group].count += run.count;
  std::size_t first = 0;
  for (std::size_t i = 1; i < groups_.size(); ++i) {
    Group& group = groups_[i];
    const Eye& before = before_[group.key & kNoEye];
    const bool is_pencil = before && turn_ == Turn::kReflected;
    if (group.count < (is_pencil ? kMinPencil : kMinRefracted)) continue;
    Eye behind;
    if (is_pencil) {
      behind = before->behind(planes_->planes()[group.key >> 16U]);
      if (!behind) continue;
      pencils_.push_back({first, group.count, behind->place, false});
    } else {
      marks_.refracted.push_back({first, group.count});
    }
    group.eye = static_cast<EyeIndex>(eyes_.size());
    group.next = first;
    eyes_.push_back(std::move(behind));
    first += group.count;
  }
  auto pencil = pencils_.begin();
  for (const Eye& eye : eyes_) {
    if (eye) (pencil++)->view = &eye->view;
  }
  groups_.front().next = first;
}

accel::RayBatch PlaneGroups::arranged(const accel::RayBatch& added) {
  if (runs_.empty()) return added;
  mark_groups();
  if (eyes_.empty()) return added;
  const std::size_t count = added.rays.size();
  places_.resize(count);
  eye_of_.resize(count);
  rays_.resize(count);
  samples_.resize(count);
  std::size_t i = 0;
  for (const Run& run : runs_) {
    const EyeIndex eye = groups_[run.group].eye;
    std::size_t& place = groups_[eye == kNoEye ? 0 : run.group].next;
    for (const std::size_t end = i + run.count; i < end; ++i, ++place) {
      places_[i] = static_cast<std::uint32_t>(place);
      eye_of_[i] = eye;
      rays_[place] = added.rays[i];
      samples_[place] = added.samples[i];
    }
  }
  return {rays_, pencils_, samples_, added.image, &marks_};
}

}  // namespace beambench::render
