#include "harness/render/pencils.hpp"

#include <bit>

#include <glm/geometric.hpp>

namespace beambench::render {
namespace {

constexpr std::uint64_t kNoKey = ~std::uint64_t{0};

std::uint64_t key_of(EyeIndex eye, std::uint32_t mirror, bool on_normals_side) {
  return (std::uint64_t{mirror} << 32U) | (std::uint64_t{eye} << 1U) | (on_normals_side ? 1U : 0U);
}
EyeIndex eye_in(std::uint64_t key) { return static_cast<EyeIndex>(key >> 1U); }
std::uint32_t mirror_in(std::uint64_t key) { return static_cast<std::uint32_t>(key >> 32U); }
bool is_on_normals_side(std::uint64_t key) { return (key & 1U) != 0; }

}  // namespace

MirrorPencils::MirrorPencils(const rays::MirrorTable& mirrors,
                             std::span<const rays::VirtualEye> eyes, std::size_t rays)
    : mirrors_(&mirrors), before_(eyes) {
  if (mirrors.mirrors().empty() || eyes.empty()) return;
  groups_.push_back({kNoKey});
  slots_.resize(std::bit_ceil(2 * rays + 1));
  group_of_.reserve(rays);
}

void MirrorPencils::add(EyeIndex eye, scenes::PrimitiveId primitive, const glm::dvec3& normal) {
  if (groups_.empty()) return;
  const std::uint32_t mirror = mirrors_->mirror_of(primitive);
  if (eye == kNoEye || mirror == rays::MirrorTable::kNone) {
    last_ = 0;
  } else {
    const double side = glm::dot(normal, mirrors_->mirrors()[mirror].normal);
    last_ = group_with(key_of(eye, mirror, side > 0.0));
  }
  ++groups_[last_].count;
  group_of_.push_back(last_);
}

std::uint32_t MirrorPencils::group_with(std::uint64_t key) {
  if (groups_[last_].key == key) return last_;
  const std::uint64_t hash = key * 0x9E3779B97F4A7C15U;  // Fibonacci hashing
  std::size_t slot = (hash >> 32U) & (slots_.size() - 1);
  while (slots_[slot] != 0 && groups_[slots_[slot]].key != key)
    slot = (slot + 1) & (slots_.size() - 1);
  if (slots_[slot] == 0) {
    slots_[slot] = static_cast<std::uint32_t>(groups_.size());
    groups_.push_back({key});
  }
  return slots_[slot];
}

void MirrorPencils::mark(Group& group, std::size_t first) {
  group.eye = static_cast<EyeIndex>(eyes_.size());
  eyes_.push_back(before_[eye_in(group.key)].behind(
      mirrors_->mirrors()[mirror_in(group.key)], is_on_normals_side(group.key), mirrors_->lift()));
  pencils_.push_back({first, group.count, eyes_.back().place, false});
}

void MirrorPencils::arrange(std::vector<accel::Ray>& rays, std::vector<std::uint32_t>& samples) {
  std::vector<std::size_t> next(groups_.size());  // place of each pencil's next ray
  std::size_t marked = 0;
  for (std::size_t i = 1; i < groups_.size(); ++i) {
    if (groups_[i].count < kMinPencil) continue;
    mark(groups_[i], marked);
    next[i] = marked;
    marked += groups_[i].count;
  }
  if (pencils_.empty()) return;
  for (std::size_t i = 0; i < pencils_.size(); ++i) pencils_[i].view = &eyes_[i].view;
  const std::vector<accel::Ray> rays_before = std::move(rays);
  const std::vector<std::uint32_t> samples_before = std::move(samples);
  rays.resize(rays_before.size());
  samples.resize(samples_before.size());
  places_.resize(rays_before.size());
  for (std::size_t i = 0; i < rays_before.size(); ++i) {
    const std::uint32_t group = group_of_[i];
    const std::size_t place = groups_[group].eye == kNoEye ? marked++ : next[group]++;
    places_[i] = place;
    rays[place] = rays_before[i];
    samples[place] = samples_before[i];
  }
}

}  // namespace beambench::render
