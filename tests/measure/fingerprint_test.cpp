// The fingerprint of scenes, rays and hits is the committed one on every instruction set.

#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "accel/core/instruction_set.hpp"
#include "tests/number_from.hpp"
#include "tests/temporary_folder.hpp"

namespace beambench {
namespace {

namespace fs = std::filesystem;

/// Returns the lines up to the total hash; the last lines differ between machines.
std::set<std::string> lines_of(const fs::path& file) {
  std::set<std::string> lines;
  std::istringstream text(read_text(file));
  for (std::string line; std::getline(text, line) && !line.starts_with("all\t");) {
    lines.insert(line);
  }
  return lines;
}

class FingerprintOn : public testing::TestWithParam<std::string> {};

TEST_P(FingerprintOn, IsTheCommittedOne) {
#ifdef __SANITIZE_ADDRESS__
  // An unoptimized build takes minutes.
  if (tests::in_full(1, 0) == 0) GTEST_SKIP() << "only with BEAMBENCH_FULL";
#endif
  if (!accel::is_available(GetParam())) GTEST_SKIP() << "this machine does not support it";
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "fingerprint.txt";
  const std::string command = "'" BEAMBENCH_BINARY "' fingerprint --isa " + GetParam() + " >'" +
                              file.string() + "' 2>/dev/null";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;

  const std::set<std::string> got = lines_of(file);
  const std::set<std::string> committed =
      lines_of(fs::path(BEAMBENCH_TEST_FILES) / "golden/fingerprint.txt");
  EXPECT_FALSE(committed.empty());
  const auto remedy = "; if it should change: beambench fingerprint > tests/golden/fingerprint.txt";
  for (const std::string& line : committed) EXPECT_TRUE(got.contains(line)) << line << remedy;
  for (const std::string& line : got) {
    // A new scene changes no committed line.
    EXPECT_TRUE(committed.contains(line) || line.starts_with("scene\t")) << line << remedy;
  }
}

INSTANTIATE_TEST_SUITE_P(EachSet, FingerprintOn, testing::Values("best", "avx2", "sse4"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace beambench
