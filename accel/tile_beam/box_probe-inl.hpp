// Determines which of sixteen boxes a tile's beam meets, where on the screen, and how close.

#if defined(ACCEL_TILE_BEAM_BOX_PROBE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_BOX_PROBE_INL
#undef ACCEL_TILE_BEAM_BOX_PROBE_INL
#else
#define ACCEL_TILE_BEAM_BOX_PROBE_INL
#endif

#include "accel/tile_beam/lanes-inl.hpp"
#include "accel/tile_beam/tile_hierarchy.hpp"
#include "accel/tile_beam/tile_image.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// A view's planes for testing boxes, with the box corner that is farthest along each plane's
/// normal.
class BoxProbe {
 public:
  explicit BoxProbe(const TileView& view)
      : rows_{view.x, view.depth * static_cast<float>(view.width - 1) - view.x, view.y,
              view.depth * static_cast<float>(view.height - 1) - view.y, view.depth},
        slacks_{view.slack_x, view.slack_x, view.slack_y, view.slack_y, view.slack_depth},
        eye_(view.eye),
        width_(static_cast<float>(view.width - 1)),
        height_(static_cast<float>(view.height - 1)) {}

  /// The boxes that the beam meets, with the samples and the largest 1/t of each.
  struct Met {
    alignas(64) std::array<std::int32_t, kTileLanes> rectangle;  ///< bytes of SampleRectangle
    alignas(64) std::array<float, kTileLanes> nearest;
    alignas(64) std::array<float, kTileLanes> samples;  ///< approximate number on the whole screen
    LaneBits lanes;

    SampleRectangle where(std::size_t lane) const {
      const auto byte = [&](unsigned index) {
        return static_cast<std::uint8_t>(static_cast<std::uint32_t>(rectangle[lane]) >> 8U * index);
      };
      return {byte(0), byte(1), byte(2), byte(3)};
    }
  };

  /// Tests boxes. A box is met if it overlaps the beam, contains a sample position and is not
  /// entirely behind `farthest` (1/t).
  HWY_INLINE void probe(const TileBoxes& boxes, std::uint32_t count, float farthest,
                        Met& met) const {
    met.lanes = for_each_register(
        [&](std::size_t lane) { return probe_register(boxes, lane, farthest, met); });
    met.lanes &= (LaneBits{1} << count) - 1;
  }

  /// Returns the children of a node whose normal cones face entirely away from the eye at every
  /// point of their boxes (Shirmun and Abi-Ezzi 1993). May include children without a cone.
  HWY_INLINE LaneBits turned_away(const TileNode& node) const {
    return for_each_register([&](std::size_t lane) {
      Floats along = hn::Zero(Tag());  // lower bound along the axis, over the box
      Floats farthest = hn::Zero(Tag());
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Floats lower = from_eye(node.boxes, axis, lane, eye_[static_cast<int>(axis)]);
        const Floats upper = from_eye(node.boxes, axis + 3, lane, eye_[static_cast<int>(axis)]);
        const Floats normal = load(&node.cones.axis[axis][lane]);
        along = hn::Add(along, hn::Min(hn::Mul(normal, lower), hn::Mul(normal, upper)));
        farthest = hn::Add(farthest, hn::Max(hn::Mul(lower, lower), hn::Mul(upper, upper)));
      }
      return hn::And(
          hn::Gt(along, hn::Zero(Tag())),
          hn::Gt(hn::Mul(along, along), hn::Mul(farthest, load(&node.cones.sine_squared[lane]))));
    });
  }

 private:
  HWY_INLINE Mask probe_register(const TileBoxes& boxes, std::size_t lane, float farthest,
                                 Met& met) const {
    const Points lower{from_eye(boxes, 0, lane, eye_.x), from_eye(boxes, 1, lane, eye_.y),
                       from_eye(boxes, 2, lane, eye_.z)};
    const Points upper{from_eye(boxes, 3, lane, eye_.x), from_eye(boxes, 4, lane, eye_.y),
                       from_eye(boxes, 5, lane, eye_.z)};
    const Floats from_left = largest(0, lower, upper);
    const Floats from_right = largest(1, lower, upper);
    const Floats from_top = largest(2, lower, upper);
    const Floats from_bottom = largest(3, lower, upper);
    const Floats none = hn::Zero(Tag());
    const Floats inside =
        hn::Min(hn::Min(from_left, from_right),
                hn::Min(hn::Min(from_top, from_bottom), largest(4, lower, upper)));

    // With the corners exchanged, this is the smallest value along the row.
    const Floats near = largest(4, upper, lower, -1.0F);
    const Mask before = hn::Gt(near, none);
    const Floats nearest = hn::IfThenElse(before, hn::Div(all(1.0F), near), all(kNearestOfAll));

    const Floats width = all(width_);
    const Floats height = all(height_);
    const Floats first_x = hn::NegMulAdd(from_right, nearest, width);
    const Floats last_x = hn::Mul(from_left, nearest);
    const Floats first_y = hn::NegMulAdd(from_bottom, nearest, height);
    const Floats last_y = hn::Mul(from_top, nearest);
    store(hn::Mul(hn::Sub(last_x, first_x), hn::Sub(last_y, first_y)), &met.samples[lane]);
    const Floats left = hn::Ceil(hn::Max(first_x, none));
    const Floats right = hn::Floor(hn::Min(last_x, width));
    const Floats top = hn::Ceil(hn::Max(first_y, none));
    const Floats bottom = hn::Floor(hn::Min(last_y, height));
    const Mask samples = hn::And(hn::Le(left, right), hn::Le(top, bottom));
    const Ints packed =
        hn::Or(hn::Or(whole(left), hn::ShiftLeft<8>(whole(right))),
               hn::Or(hn::ShiftLeft<16>(whole(top)), hn::ShiftLeft<24>(whole(bottom))));
    hn::Store(packed, IntTag(), &met.rectangle[lane]);
    store(nearest, &met.nearest[lane]);
    return hn::And(hn::And(hn::Ge(inside, none), samples), hn::Ge(nearest, all(farthest)));
  }

  static HWY_INLINE Ints whole(Floats values) { return hn::ConvertTo(IntTag(), values); }
  static HWY_INLINE Floats from_eye(const TileBoxes& boxes, std::size_t plane, std::size_t lane,
                                    float eye) {
    return hn::Sub(load(&boxes.planes[plane][lane]), all(eye));
  }
  /// Returns the largest value along a row over the boxes, plus `slacks` times the row's slack.
  HWY_INLINE Floats largest(std::size_t row, const Points& lower, const Points& upper,
                            float slacks = 1.0F) const {
    const glm::vec3& along = rows_[row];
    const Floats x = along.x > 0.0F ? upper.x : lower.x;
    const Floats y = along.y > 0.0F ? upper.y : lower.y;
    const Floats z = along.z > 0.0F ? upper.z : lower.z;
    return hn::MulAdd(
        all(along.x), x,
        hn::MulAdd(all(along.y), y, hn::MulAdd(all(along.z), z, all(slacks * slacks_[row]))));
  }

  std::array<glm::vec3, 5> rows_;
  std::array<float, 5> slacks_;
  glm::vec3 eye_;
  float width_;
  float height_;
};

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
