// Draws triangles that cover a few blocks each: lanes find the blocks, which are then drawn one by
// one.

#if defined(ACCEL_TILE_BEAM_TRIANGLE_BLOCKS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_TRIANGLE_BLOCKS_INL
#undef ACCEL_TILE_BEAM_TRIANGLE_BLOCKS_INL
#else
#define ACCEL_TILE_BEAM_TRIANGLE_BLOCKS_INL
#endif

#include "accel/tile_beam/stored_images-inl.hpp"
#include "accel/tile_beam/tile_raster-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// Triangles with at most this many blocks in their box are drawn from a list of blocks.
inline constexpr int kMaxListedBlocks = 30;

/// A list of blocks that triangles may meet. An entry is a block's place in the tile, with the
/// triangle's lane in four unused bits.
struct BlockList {
  static constexpr std::size_t kMaxEntries =
      16 * kMaxListedBlocks + 16;  // room for a whole register at the end

  alignas(64) std::array<std::int32_t, kMaxEntries> entries;
  std::size_t count;
};

/// The box of each triangle in blocks.
struct BlockBoxes {
  Floats left;  ///< first sample of the first block
  Floats right;
  Floats top;
  Floats bottom;

  HWY_INLINE explicit BlockBoxes(const TriangleImages& images)
      : left(first_of_block(images.left)),
        right(first_of_block(images.right)),
        top(first_of_block(images.top)),
        bottom(first_of_block(images.bottom)) {}

  HWY_INLINE Floats count() const {
    const Floats quarter = all(0.25F);
    return hn::Mul(hn::MulAdd(hn::Sub(right, left), quarter, all(1.0F)),
                   hn::MulAdd(hn::Sub(bottom, top), quarter, all(1.0F)));
  }

 private:
  static HWY_INLINE Floats first_of_block(Floats samples) {
    const Ints whole = hn::ConvertTo(IntTag(), samples);
    return hn::ConvertTo(Tag(), hn::AndNot(hn::Set(IntTag(), 3), whole));
  }
};

/// Returns the edge's largest value on a block, as a line over the blocks' first samples.
HWY_INLINE Lines largest_on_block(const Lines& edge) {
  const Floats none = hn::Zero(Tag());
  const Floats three = all(3.0F + 0x1p-6F);  // plus a little for rounding
  return {edge.x, edge.y,
          hn::Add(edge.constant, hn::Add(hn::Max(none, hn::Mul(edge.x, three)),
                                         hn::Max(none, hn::Mul(edge.y, three))))};
}

/// Lets each lane walk through the blocks of its triangle's box, row by row.
HWY_INLINE void list_blocks(const TriangleImages& images, const BlockBoxes& boxes, Mask listed,
                            BlockList& list) {
  const Lines edge0 = largest_on_block(images.edge0);
  const Lines edge1 = largest_on_block(images.edge1);
  const Lines edge2 = largest_on_block(images.edge2);
  const Floats four = all(4.0F);
  const Ints lane = hn::Iota(IntTag(), 0);
  Floats i = boxes.left;
  Floats j = boxes.top;
  list.count = 0;
  do {
    const Floats edge = hn::Min(edge0.at(i, j), hn::Min(edge1.at(i, j), edge2.at(i, j)));
    const Mask met = hn::And(listed, hn::Ge(edge, hn::Zero(Tag())));
    const Ints place = hn::Or(hn::ShiftLeft<TileImage::kWidthBits>(hn::ConvertTo(IntTag(), j)),
                              hn::ShiftLeft<2>(hn::ConvertTo(IntTag(), i)));
    list.count += compress_store(IntTag(), hn::Or(place, lane), hn::RebindMask(IntTag(), met),
                                 list.entries.data() + list.count);
    i = hn::Add(i, four);
    const Mask row_ends = hn::Gt(i, boxes.right);
    i = hn::IfThenElse(row_ends, boxes.left, i);
    j = hn::Add(j, hn::IfThenElseZero(row_ends, four));
    listed = hn::And(listed, hn::Le(j, boxes.bottom));
  } while (!hn::AllFalse(Tag(), listed));
}

/// The sample positions of each column or row of blocks: a look-up is faster than computing them.
template <std::size_t kCount>
struct BlockPlaces {
  alignas(64) std::array<std::array<float, TileImage::kBlockSamples>, kCount> places;

  constexpr explicit BlockPlaces(bool rows) : places{} {
    for (std::size_t block = 0; block < kCount; ++block) {
      for (std::size_t i = 0; i < TileImage::kBlockSamples; ++i) {
        places[block][i] = static_cast<float>(4 * block + (rows ? i / 4 : i % 4));
      }
    }
  }
  HWY_INLINE Floats at(std::size_t block, std::size_t first) const {
    return load(&places[block][first]);
  }
};
inline constexpr BlockPlaces<TileImage::kBlockColumns> kColumnPlaces(false);
inline constexpr BlockPlaces<TileImage::kBlockRows> kRowPlaces(true);

HWY_INLINE void paint_list(const BlockList& list, const StoredImages& images,
                           const scenes::PrimitiveId* primitives, TileImage& image) {
  for (std::size_t entry = 0; entry < list.count; ++entry) {
    const auto packed = static_cast<std::uint32_t>(list.entries[entry]);
    const std::size_t lane = packed & 15U;
    const std::size_t block = packed & ~15U;
    const std::size_t column = packed >> 4U & (TileImage::kBlockColumns - 1U);
    const std::size_t row = packed >> (TileImage::kWidthBits + 2);
    const auto line = [&](std::size_t which, Floats i, Floats j) {
      return hn::MulAdd(all(images.lines[3 * which][lane]), i,
                        hn::MulAdd(all(images.lines[3 * which + 1][lane]), j,
                                   all(images.lines[3 * which + 2][lane])));
    };
    for (std::size_t first = 0; first < TileImage::kBlockSamples; first += kLanes) {
      const Floats i = kColumnPlaces.at(column, first);
      const Floats j = kRowPlaces.at(row, first);
      const Floats edge = hn::Min(line(0, i, j), hn::Min(line(1, i, j), line(2, i, j)));
      keep_nearer(image, block + first, line(3, i, j), hn::Ge(edge, hn::Zero(Tag())),
                  primitives[lane]);
    }
  }
}

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
