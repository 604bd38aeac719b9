// Properties of divisions: every task is in one share, and every pixel in one tile.

#include "harness/thesis/cluster/image_division.hpp"

#include <cstddef>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "accel/beam/sample_lattice.hpp"

namespace beambench::cluster {
namespace {

constexpr ImageDivision kImageDivisions[] = {ImageDivision::kContiguous, ImageDivision::kInterlaced,
                                             ImageDivision::kEqualCost, ImageDivision::kBatches,
                                             ImageDivision::kFalling};

TEST(ImageDivision, HasEveryTaskOnceAndNoEmptyShare) {
  for (const ImageDivision division : kImageDivisions) {
    for (const std::size_t tasks : {0U, 1U, 7U, 100U, 5000U}) {
      for (const int consumers : {1, 3, 64, 1023}) {
        const std::vector<double> costs(tasks, 2.0);
        std::multiset<std::size_t> all;
        for (const Share& share : divide(division, tasks, {consumers, 16, costs})) {
          EXPECT_FALSE(share.empty());
          all.insert(share.begin(), share.end());
        }
        ASSERT_EQ(all.size(), tasks);
        std::size_t expected = 0;
        for (const std::size_t task : all) EXPECT_EQ(task, expected++);
      }
    }
  }
}

TEST(ImageDivision, MatchesItsName) {
  EXPECT_EQ(divide(ImageDivision::kContiguous, 5, {2, 1, {}}),
            (std::vector<Share>{{0, 1, 2}, {3, 4}}));
  EXPECT_EQ(divide(ImageDivision::kInterlaced, 5, {2, 1, {}}),
            (std::vector<Share>{{0, 2, 4}, {1, 3}}));
  const std::vector<double> costs{1.0, 5.0, 2.0, 3.0, 1.0};
  EXPECT_EQ(divide(ImageDivision::kEqualCost, 5, {2, 1, costs}),
            (std::vector<Share>{{0, 1}, {2, 3, 4}}));  // 6 and 6
}

TEST(ImageDivision, OfFallingSharesEndsWithSmallOnesAndTakesFewMessages) {
  const std::vector<Share> shares = divide(ImageDivision::kFalling, 262144, {1023, 1, {}});
  EXPECT_LT(shares.size(), 4 * 1023U);
  for (std::size_t i = 1; i < shares.size(); ++i) {
    EXPECT_LE(shares[i].size(), shares[i - 1].size());
    EXPECT_EQ(shares[i].front(), shares[i - 1].back() + 1);  // a range
  }
  EXPECT_LE(shares.back().size(), 262144 / 1023 / 5U);
}

TEST(TileOrder, HasEveryPixelOnce) {
  for (const int width : {1, 7, 32, 53}) {
    for (const int height : {1, 41, 64}) {
      for (const int size : {1, 8, 100}) {
        const TileOrder order(width, height, size);
        std::vector<int> seen(static_cast<std::size_t>(width * height), 0);
        for (std::size_t i = 0; i < order.count(); ++i) {
          const accel::beam::PixelRect tile = order[i];
          for (int y = tile.top; y < tile.top + tile.height; ++y) {
            for (int x = tile.left; x < tile.left + tile.width; ++x) {
              ++seen[static_cast<std::size_t>(y * width + x)];
            }
          }
        }
        for (const int times : seen) ASSERT_EQ(times, 1) << width << 'x' << height << ' ' << size;
      }
    }
  }
}

TEST(TileOrder, SpreadsTheRemainingTilesOverTheImage) {
  const TileOrder order(1024, 1024, 16);
  for (std::size_t first = 0; first < order.count(); first += 64) {
    std::vector<int> in_part(16, 0);  // of 4 x 4 parts of the image
    for (std::size_t i = first; i < first + 64; ++i) {
      ++in_part[static_cast<std::size_t>(order[i].top / 256 * 4 + order[i].left / 256)];
    }
    for (const int tiles : in_part) EXPECT_NEAR(tiles, 4, 3);
  }
}

TEST(Work, IsNamed) {
  for (const Work work : {Work::kBeams, Work::kBlocks, Work::kTiles, Work::kContiguous,
                          Work::kInterlaced, Work::kWindows, Work::kPrePass}) {
    EXPECT_EQ(work_named(name_of(work)), work);
  }
  EXPECT_FALSE(work_named("rays"));
}

}  // namespace
}  // namespace beambench::cluster
