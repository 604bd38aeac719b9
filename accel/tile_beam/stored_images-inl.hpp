// The images of triangles in memory, for access one by one.

#if defined(ACCEL_TILE_BEAM_STORED_IMAGES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_STORED_IMAGES_INL
#undef ACCEL_TILE_BEAM_STORED_IMAGES_INL
#else
#define ACCEL_TILE_BEAM_STORED_IMAGES_INL
#endif

#include "accel/tile_beam/tile_view.hpp"
#include "accel/tile_beam/triangle_setup-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

struct StoredImages {
  alignas(64) std::array<std::array<float, kLanes>, 12> lines;
  alignas(64) std::array<std::array<float, kLanes>, 4> box;

  HWY_INLINE explicit StoredImages(const TriangleImages& images) {
    const std::array<const Lines*, 4> all_lines{&images.edge0, &images.edge1, &images.edge2,
                                                &images.plane};
    for (std::size_t line = 0; line < 4; ++line) {
      store(all_lines[line]->x, lines[3 * line].data());
      store(all_lines[line]->y, lines[3 * line + 1].data());
      store(all_lines[line]->constant, lines[3 * line + 2].data());
    }
    store(images.left, box[0].data());
    store(images.right, box[1].data());
    store(images.top, box[2].data());
    store(images.bottom, box[3].data());
  }

  HWY_INLINE TileLine line(std::size_t which, std::size_t lane) const {
    return {lines[3 * which][lane], lines[3 * which + 1][lane], lines[3 * which + 2][lane]};
  }
  HWY_INLINE SampleRectangle rectangle(std::size_t lane) const {
    const auto side = [&](std::size_t which) {
      return static_cast<std::uint8_t>(static_cast<int>(box[which][lane]));
    };
    return {side(0), side(1), side(2), side(3)};
  }
};

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
