// Properties of kept results: finished ones are used, truncated ones are not, and the picture is
// the same.

#include "harness/thesis/cluster/kept_results.hpp"

#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "harness/thesis/cluster/image_division.hpp"
#include "harness/thesis/cluster/run.hpp"
#include "scenes/base/error.hpp"
#include "tests/temporary_folder.hpp"
#include "tests/thesis/cluster/followers.hpp"
#include "tests/thesis/cluster/local_network.hpp"

namespace beambench::cluster {
namespace {

namespace fs = std::filesystem;

Bytes bytes_of(std::string_view text) {
  Bytes bytes;
  ByteWriter(bytes).put_bytes(std::as_bytes(std::span(text)));
  return bytes;
}

/// A folder for a picture, initially empty.
class KeptResults : public ::testing::Test {
 protected:
  static std::size_t count(const KeptFolder& folder, const std::string& key) {
    std::size_t found = 0;
    folder.read(key, [&](auto, auto) { ++found; });
    return found;
  }

  TemporaryFolder folder_;  // unique to this test, because others run at the same time
  fs::path place_ = folder_.path();
  fs::path picture_ = place_ / "picture.png";
};

TEST_F(KeptResults, AreReadOnceUnlessTruncatedOrDamaged) {
  {
    KeptFolder folder(picture_, false);
    KeptFile first(folder.path(), 0, "key\n");
    first.add(bytes_of("a"), bytes_of("result of a"));
    first.add(bytes_of("b"), bytes_of("result of b"));
    KeptFile second(folder.path(), 1, "key\n");
    second.add(bytes_of("a"), bytes_of("result of a"));
    second.add(bytes_of("c"), bytes_of("result of c"));
    EXPECT_EQ(count(folder, "key\n"), 3U);
    EXPECT_THROW(KeptFolder(picture_, true), InputError);  // it is in use
  }
  const fs::path file = place_ / "picture.png.kept" / "results-1-0";
  fs::resize_file(file, fs::file_size(file) - 3);
  EXPECT_EQ(count(KeptFolder(picture_, true), "key\n"), 2U);
  std::fstream(file).seekp(4 + 4 + 24) << 'x';  // behind the key, and the sum and sizes: task a
  const fs::path other = place_ / "picture.png.kept" / "results-0-0";
  fs::resize_file(other, 4 + 4);  // the key alone
  EXPECT_EQ(count(KeptFolder(picture_, true), "key\n"), 0U);
}

TEST_F(KeptResults, OfAnotherPictureAreRefusedWithTheDifference) {
  KeptFolder folder(picture_, false);
  KeptFile file(folder.path(), 0, "scene a\nimage 10x10\n");
  file.add(bytes_of("a"), {});
  try {
    count(folder, "scene a\nimage 20x20\n");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("'image 10x10', this run has 'image 20x20'"),
              std::string::npos)
        << error.what();
  }
}

TEST_F(KeptResults, LeaveNoEmptyFolder) {
  {
    const KeptFolder folder(picture_, false);
    const KeptFile file(folder.path(), 0, "key\n");
  }
  EXPECT_TRUE(fs::is_empty(place_));
}

ClusterRequest request_for(Work work, const fs::path& picture, bool resume, bool stored) {
  ClusterRequest request;
  request.job.scene = "tetra:n=3";
  request.job.structure = "beam:max_level=5";
  request.job.resolution = {61, 47};
  request.job.samples = 5;
  request.job.light = true;
  request.shading = render::Shading::kWhitted;
  request.work = work;
  request.block_size = 9;
  request.job.work = name_of(work);
  request.picture = picture;
  request.kept = std::make_shared<KeptFolder>(picture, resume);
  if (stored) request.job.stored = request.kept->path();
  return request;
}

ClusterRun run(const ClusterRequest& request, int processes) {
  LocalNetwork network(processes, 1, 0.0001);
  return led(lead, request, network);
}

TEST_F(KeptResults, YieldTheSamePictureAfterAnyInterruption) {
  const std::uint64_t expected =
      run(request_for(Work::kBeams, picture_, false, false), 1).result_hash;
  for (const Work work : {Work::kBeams, Work::kBlocks, Work::kTiles, Work::kInterlaced}) {
    for (const bool stored : {false, true}) {
      // A whole run keeps its results, because it cannot write its picture. They are then
      // truncated.
      ClusterRequest whole = request_for(work, picture_, false, stored);
      whole.picture = (place_ / "none" / "a.png").string();
      EXPECT_THROW(run(whole, 3), InputError);
      whole.kept.reset();
      for (const auto& file : fs::directory_iterator(place_ / "picture.png.kept")) {
        fs::resize_file(file, fs::file_size(file) * 9 / 10);
      }
      const ClusterRun rest = run(request_for(work, picture_, true, !stored), 2);
      EXPECT_EQ(rest.result_hash, expected) << name_of(work) << ' ' << stored;
      EXPECT_GT(rest.resumed_tasks, 0U) << name_of(work) << ' ' << stored;
      EXPECT_GT(rest.report.tasks.size(), 0U);
      EXPECT_FALSE(fs::exists(place_ / "picture.png.kept"));
      EXPECT_TRUE(fs::exists(picture_));
    }
  }
}

}  // namespace
}  // namespace beambench::cluster
