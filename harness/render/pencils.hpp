#pragma once
// The pencils and refracted rays of a picture's batches.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "accel/core/ray.hpp"
#include "accel/core/ray_batch.hpp"
#include "harness/rays/virtual_eye.hpp"

namespace beambench::render {

/// The minimum number of rays of a pencil; fewer are not marked.
inline constexpr std::size_t kMinPencil = 16;
/// Likewise for refracted rays, which are divided further.
inline constexpr std::size_t kMinRefracted = 64;

/// The virtual eye of rays that came from the camera through planes only; nothing if a plane
/// refracted them, so that they have no common point.
using Eye = std::optional<rays::VirtualEye>;

/// The index of the eye through which a ray comes; kNoEye for a ray that a curved surface reflected
/// or refracted, and for one in a small group.
using EyeIndex = std::uint16_t;
inline constexpr EyeIndex kNoEye = static_cast<EyeIndex>(~EyeIndex{0});

/// The way in which a plane turns rays.
enum class Turn { kReflected, kRefracted };

/// Groups the rays that a part of a wave sends from planes, by the eyes before and the planes. Each
/// group with enough rays is marked, as a pencil or as refracted rays; the other rays follow. Rays
/// of a group, and those without, stay in order.
class PlaneGroups {
 public:
  /// Groups rays through `eyes`, the camera's or those of the wave. All arguments must outlive this
  /// object.
  PlaneGroups(Turn turn, const rays::PlaneTable& planes, std::span<const Eye> eyes);
  PlaneGroups(const PlaneGroups&) = delete;  // batches refer to it
  PlaneGroups& operator=(const PlaneGroups&) = delete;
  ~PlaneGroups() = default;

  /// Adds the next ray, which comes from `eye` and is turned by a primitive.
  void add(EyeIndex eye, scenes::PrimitiveId primitive) {
    if (groups_.empty()) return;
    const std::uint32_t plane = planes_->plane_of(primitive);
    const bool is_known = eye != kNoEye && plane != rays::PlaneTable::kNone;
    const std::uint64_t key = is_known ? key_of(eye, plane) : kNoKey;
    if (runs_.empty() || key != groups_[runs_.back().group].key) {
      runs_.push_back({group_with(key), 0});
    }
    ++runs_.back().count;
  }

  /// Once all rays have been added, takes their batch in the order of `add` and returns the batch
  /// in the order of the groups, which it marks.
  accel::RayBatch arranged(const accel::RayBatch& added);
  /// Returns the place there of the i-th added ray.
  std::size_t place_of(std::size_t i) const { return eyes_.empty() ? i : places_[i]; }
  /// Returns the index in `eyes` of the ray's eye.
  EyeIndex eye_of(std::size_t i) const { return eyes_.empty() ? kNoEye : eye_of_[i]; }
  /// Returns one eye for each marked group. They own the pencils' views.
  const std::vector<Eye>& eyes() const { return eyes_; }

 private:
  /// Rays through one eye.
  struct Group {
    std::uint64_t key;  ///< the eye before the plane, and the plane
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
  static std::uint64_t key_of(EyeIndex eye, std::uint32_t plane) {
    return (std::uint64_t{plane} << 16U) | eye;
  }
  std::uint32_t group_with(std::uint64_t key);
  std::uint32_t& slot_of(std::uint64_t key);
  void mark_groups();

  Turn turn_;
  const rays::PlaneTable* planes_;
  std::span<const Eye> before_;
  std::vector<Group> groups_;         ///< the first: rays without an eye; empty without planes
  std::vector<std::uint32_t> slots_;  ///< a hash table of groups; 0 in free slots
  std::vector<Run> runs_;
  std::vector<Eye> eyes_;
  std::vector<accel::Pencil> pencils_;
  accel::BatchMarks marks_;
  std::vector<std::uint32_t> places_;  ///< of each added ray; empty without marks, like the next
  std::vector<EyeIndex> eye_of_;       ///< of each ray added
  std::vector<accel::Ray> rays_;
  std::vector<std::uint32_t> samples_;
};

}  // namespace beambench::render
