// Finds the blocks of a row that lie between edges.

#if defined(ACCEL_TILE_BEAM_ROW_ENDS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_ROW_ENDS_INL
#undef ACCEL_TILE_BEAM_ROW_ENDS_INL
#else
#define ACCEL_TILE_BEAM_ROW_ENDS_INL
#endif

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "accel/tile_beam/lanes-inl.hpp"
#include "accel/tile_beam/tile_image.hpp"
#include "accel/tile_beam/tile_view.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// For each row, the blocks between some edges; all others lie outside an edge.
class RowEnds {
 public:
  template <std::size_t kEdges>
  HWY_INLINE RowEnds(const std::array<TileLine, kEdges>& edges, int first_column, int last_column) {
    for (std::size_t row = 0; row < TileImage::kBlockRows; row += kLanes) {
      const Floats top = hn::Iota(Tag(), static_cast<float>(row));
      Floats low = all(static_cast<float>(4 * first_column));
      Floats high = all(static_cast<float>(4 * last_column + 3));
      for (const TileLine& edge : edges) {
        // The largest value on a column of the first block, plus a small margin for rounding.
        const float largest = edge.constant + (edge.y > 0.0F ? 3.0F * edge.y : 0.0F) +
                              0x1p-21F * (std::abs(edge.constant) + std::abs(kTileHeight * edge.y));
        const Floats value = hn::MulAdd(all(4.0F * edge.y), top, all(largest));
        constexpr float kLevel = 1e-30F;  // an edge this flat does not end a row
        constexpr float kSlack = 0.0625F;
        if (edge.x > kLevel) {
          low = hn::Max(low, hn::MulAdd(value, all(-1.0F / edge.x), all(-kSlack)));
        } else if (edge.x < -kLevel) {
          high = hn::Min(high, hn::MulAdd(value, all(-1.0F / edge.x), all(kSlack)));
        }
      }
      const auto block_of = [](Floats sample) {
        return hn::ShiftRight<2>(hn::ConvertTo(IntTag(), hn::Floor(sample)));
      };
      hn::Store(block_of(hn::Min(low, all(1e6F))), IntTag(), &first_[row]);
      hn::Store(block_of(hn::Max(high, all(-4.0F))), IntTag(), &last_[row]);
    }
  }

  int first(int row) const { return first_[static_cast<std::size_t>(row)]; }
  int last(int row) const { return last_[static_cast<std::size_t>(row)]; }

 private:
  alignas(64) std::array<std::int32_t, TileImage::kBlockRows> first_;
  alignas(64) std::array<std::int32_t, TileImage::kBlockRows> last_;
};

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
