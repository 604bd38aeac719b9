#pragma once
// The pencils of a picture's batches.

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "accel/core/ray.hpp"
#include "accel/core/ray_batch.hpp"
#include "harness/rays/virtual_eye.hpp"

namespace beambench::render {

/// Fewer rays than this are not marked as a pencil.
inline constexpr std::size_t kMinPencil = 16;

/// Which of some virtual eyes a ray comes through; kNoEye for a ray that was refracted or that a
/// curved mirror reflected, and for one with few others.
using EyeIndex = std::uint16_t;
inline constexpr EyeIndex kNoEye = ~EyeIndex{0};

/// The mirror rays of a part of a wave, brought into the order of their virtual eyes: each eye with
/// enough rays is a pencil; the other rays follow. Rays of an eye, and those without, stay in their
/// order.
class MirrorPencils {
 public:
  /// For at most `rays` rays. All must outlive this.
  MirrorPencils(const rays::MirrorTable& mirrors, std::span<const rays::VirtualEye> eyes,
                std::size_t rays);

  /// The next ray, from `eye` by a primitive, to the side of it that `normal` points to.
  void add(EyeIndex eye, scenes::PrimitiveId primitive, const glm::dvec3& normal);

  /// Once all rays are there: orders rays and samples, which are in the order of `add`.
  void arrange(std::vector<accel::Ray>& rays, std::vector<std::uint32_t>& samples);
  std::span<const accel::Pencil> pencils() const { return pencils_; }
  /// Where the i-th ray that was added is now.
  std::size_t place_of(std::size_t i) const { return pencils_.empty() ? i : places_[i]; }
  /// Through which of `take_eyes` it comes.
  EyeIndex eye_of(std::size_t i) const {
    return pencils_.empty() ? kNoEye : groups_[group_of_[i]].eye;
  }
  /// One for each pencil. The pencils' views are then theirs.
  std::vector<rays::VirtualEye> take_eyes() && { return std::move(eyes_); }

 private:
  /// Rays through one virtual eye.
  struct Group {
    std::uint64_t key;  ///< the eye before the mirror, the mirror and its side
    std::size_t count = 0;
    EyeIndex eye = kNoEye;
  };
  std::uint32_t group_with(std::uint64_t key);
  void mark(Group& group, std::size_t first);

  const rays::MirrorTable* mirrors_;
  std::span<const rays::VirtualEye> before_;
  std::vector<Group> groups_;            ///< the first of them: rays without a virtual eye
  std::vector<std::uint32_t> slots_;     ///< a hash table of groups; 0 where there is none
  std::vector<std::uint32_t> group_of_;  ///< of each ray; none without planar mirrors
  std::uint32_t last_ = 0;               ///< the group of the ray before, mostly that of the next
  std::vector<rays::VirtualEye> eyes_;
  std::vector<accel::Pencil> pencils_;
  std::vector<std::size_t> places_;  ///< of each ray; none without pencils
};

}  // namespace beambench::render
