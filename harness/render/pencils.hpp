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

/// The minimum number of rays in a pencil; smaller groups are not marked.
inline constexpr std::size_t kMinPencil = 16;
/// The minimum for refracted rays, which are divided further.
inline constexpr std::size_t kMinRefracted = 64;

/// The virtual eye of rays that came from the camera via planes only; nothing if a plane refracted
/// them, because they then have no common point.
using Eye = std::optional<rays::VirtualEye>;

/// The index of the eye through which a ray comes; kNoEye for a ray that a curved surface reflected
/// or refracted, and for a ray in a small group.
using EyeIndex = std::uint16_t;
inline constexpr EyeIndex kNoEye = static_cast<EyeIndex>(~EyeIndex{0});

/// How a plane turns rays.
enum class Turn { kReflected, kRefracted };

/// Groups the rays that leave planes in a part of a wave, by the eye before the plane and by the
/// plane. Each group with enough rays is marked, as a pencil or as refracted rays; the other rays
/// come last. Rays stay in order within their group, and so do rays without a group.
class PlaneGroups {
 public:
  /// Groups rays through `eyes`, the camera's or those of the wave. All arguments must outlive this
  /// object.
  PlaneGroups(Turn turn, const rays::PlaneTable& planes, std::span<const Eye> eyes);
  PlaneGroups(const PlaneGroups&) = delete;  // batches refer to it
  PlaneGroups& operator=(const PlaneGroups&) = delete;
  ~PlaneGroups() = default;

  /// Adds the next ray: it comes from `eye` and was reflected or refracted by `primitive`.
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

  /// Takes the batch of all added rays, in the order of `add`, and returns it in the order of the
  /// groups, which it marks. Call it after adding all rays.
  accel::RayBatch arranged(const accel::RayBatch& added);
  /// Returns the place of the i-th added ray in that batch.
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
    std::size_t next = 0;  ///< the place for its next ray
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
  std::vector<std::uint32_t> places_;  ///< of each added ray; empty without marks, like `eye_of_`
  std::vector<EyeIndex> eye_of_;       ///< of each added ray
  std::vector<accel::Ray> rays_;
  std::vector<std::uint32_t> samples_;
};

}  // namespace beambench::render
