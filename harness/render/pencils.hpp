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
inline constexpr EyeIndex kNoEye = static_cast<EyeIndex>(~EyeIndex{0});

/// The mirror rays of a part of a wave by their virtual eyes: each eye with enough rays is a
/// pencil; the other rays follow. Rays of an eye, and those without, stay in their order.
class MirrorPencils {
 public:
  /// Of rays through `eyes`, the camera's or those of the wave. All must outlive this.
  MirrorPencils(const rays::MirrorTable& mirrors, std::span<const rays::VirtualEye> eyes);

  /// The next ray, which comes from `eye` and is reflected by a primitive.
  void add(EyeIndex eye, scenes::PrimitiveId primitive) {
    if (groups_.empty()) return;
    const std::uint32_t mirror = mirrors_->mirror_of(primitive);
    const bool is_known = eye != kNoEye && mirror != rays::MirrorTable::kNone;
    const std::uint64_t key = is_known ? key_of(eye, mirror) : kNoKey;
    if (runs_.empty() || key != groups_[runs_.back().group].key) {
      runs_.push_back({group_with(key), 0});
    }
    ++runs_.back().count;
  }

  /// Once all rays are there: from the batch of them in the order of `add` that in the order of the
  /// pencils, which it marks.
  accel::RayBatch arranged(const accel::RayBatch& added);
  /// Where the i-th ray that was added is there.
  std::size_t place_of(std::size_t i) const { return pencils_.empty() ? i : places_[i]; }
  /// Through which of `take_eyes` it comes.
  EyeIndex eye_of(std::size_t i) const { return pencils_.empty() ? kNoEye : eye_of_[i]; }
  /// One for each pencil. The pencils' views are then theirs.
  std::vector<rays::VirtualEye> take_eyes() && { return std::move(eyes_); }

 private:
  /// Rays through one virtual eye.
  struct Group {
    std::uint64_t key;  ///< the eye before the mirror, and the mirror
    std::size_t count = 0;
    EyeIndex eye = kNoEye;
    std::size_t next = 0;  ///< the place of its next ray
  };
  /// Rays of one group that were added in succession.
  struct Run {
    std::uint32_t group;
    std::uint32_t count;
  };
  static constexpr std::uint64_t kNoKey = ~std::uint64_t{0};
  static std::uint64_t key_of(EyeIndex eye, std::uint32_t mirror) {
    return (std::uint64_t{mirror} << 16U) | eye;
  }
  std::uint32_t group_with(std::uint64_t key);
  std::uint32_t& slot_of(std::uint64_t key);
  void mark_pencils();

  const rays::MirrorTable* mirrors_;
  std::span<const rays::VirtualEye> before_;
  std::vector<Group> groups_;  ///< the first: rays without a virtual eye; none without mirrors
  std::vector<std::uint32_t> slots_;  ///< a hash table of groups; 0 where no group is
  std::vector<Run> runs_;
  std::vector<rays::VirtualEye> eyes_;
  std::vector<accel::Pencil> pencils_;
  std::vector<std::uint32_t> places_;  ///< of each ray added; none without pencils, as what follows
  std::vector<EyeIndex> eye_of_;       ///< of each ray added
  std::vector<accel::Ray> rays_;
  std::vector<std::uint32_t> samples_;
};

}  // namespace beambench::render
