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

/// The minimum number of rays of a pencil; fewer are not marked.
inline constexpr std::size_t kMinPencil = 16;

/// The index of the virtual eye through which a ray comes; kNoEye for a ray that was refracted or
/// reflected by a curved mirror, and for one in a small group.
using EyeIndex = std::uint16_t;
inline constexpr EyeIndex kNoEye = static_cast<EyeIndex>(~EyeIndex{0});

/// Groups the mirror rays of a part of a wave by their virtual eyes: each eye with enough rays is a
/// pencil; the other rays follow. Rays of an eye, and those without, stay in order.
class MirrorPencils {
 public:
  /// Groups rays through `eyes`, the camera's or those of the wave. All arguments must outlive this
  /// object.
  MirrorPencils(const rays::MirrorTable& mirrors, std::span<const rays::VirtualEye> eyes);

  /// Adds the next ray, which comes from `eye` and is reflected by a primitive.
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

  /// Once all rays have been added, takes their batch in the order of `add` and returns the batch
  /// in the order of the pencils, which it marks.
  accel::RayBatch arranged(const accel::RayBatch& added);
  /// Returns the place there of the i-th added ray.
  std::size_t place_of(std::size_t i) const { return pencils_.empty() ? i : places_[i]; }
  /// Returns the index in `take_eyes` of the ray's eye.
  EyeIndex eye_of(std::size_t i) const { return pencils_.empty() ? kNoEye : eye_of_[i]; }
  /// Returns one eye for each pencil, and the ownership of the pencils' views.
  std::vector<rays::VirtualEye> take_eyes() && { return std::move(eyes_); }

 private:
  /// Rays through one virtual eye.
  struct Group {
    std::uint64_t key;  ///< the eye before the mirror, and the mirror
    std::size_t count = 0;
    EyeIndex eye = kNoEye;
    std::size_t next = 0;  ///< the place of its next ray
  };
  /// Consecutively added rays of one group.
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
  std::vector<Group> groups_;  ///< the first: rays without a virtual eye; empty without mirrors
  std::vector<std::uint32_t> slots_;  ///< a hash table of groups; 0 in free slots
  std::vector<Run> runs_;
  std::vector<rays::VirtualEye> eyes_;
  std::vector<accel::Pencil> pencils_;
  std::vector<std::uint32_t> places_;  ///< of each added ray; empty without pencils, like the next
  std::vector<EyeIndex> eye_of_;       ///< of each ray added
  std::vector<accel::Ray> rays_;
  std::vector<std::uint32_t> samples_;
};

}  // namespace beambench::render
