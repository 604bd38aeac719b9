#include "harness/render/pencils.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

namespace beambench::render {

MirrorPencils::MirrorPencils(const rays::MirrorTable& mirrors,
                             std::span<const rays::VirtualEye> eyes)
    : mirrors_(&mirrors), before_(eyes) {
  if (mirrors.mirrors().empty() || eyes.empty()) return;
  groups_.push_back({kNoKey});
  slots_.resize(64);
}

std::uint32_t MirrorPencils::group_with(std::uint64_t key) {
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
std::uint32_t& MirrorPencils::slot_of(std::uint64_t key) {
  std::size_t slot = (key * 0x9E3779B97F4A7C15U) >> 32U;  // Fibonacci hashing
  do {
    slot = (slot + 1) & (slots_.size() - 1);
  } while (slots_[slot] != 0 && groups_[slots_[slot]].key != key);
  return slots_[slot];
}

/// Gives each group with enough rays an eye, and all groups their places.
void MirrorPencils::mark_pencils() {
  for (const Run& run : runs_) groups_[run.group].count += run.count;
  std::size_t first = 0;
  for (std::size_t i = 1; i < groups_.size(); ++i) {
    Group& group = groups_[i];
    if (group.count < kMinPencil) continue;
    const rays::VirtualEye& before = before_[group.key & kNoEye];
    auto behind = before.behind(mirrors_->mirrors()[group.key >> 16U]);
    if (!behind) continue;
    group.eye = static_cast<EyeIndex>(eyes_.size());
    group.next = first;
    pencils_.push_back({first, group.count, behind->place, false});
    eyes_.push_back(*std::move(behind));
    first += group.count;
  }
  for (std::size_t i = 0; i < pencils_.size(); ++i) pencils_[i].view = &eyes_[i].view;
  groups_.front().next = first;
}

accel::RayBatch MirrorPencils::arranged(const accel::RayBatch& added) {
  if (runs_.empty()) return added;
  mark_pencils();
  if (pencils_.empty()) return added;
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
  return {rays_, pencils_, samples_, added.image};
}

}  // namespace beambench::render
