// Properties of sweeps that are found by name.

#include "harness/measure/find_sweep.hpp"

#include <gtest/gtest.h>

#include "harness/measure/config.hpp"
#include "scenes/base/error.hpp"
#include "tests/temporary_folder.hpp"

namespace beambench::measure {
namespace {

TEST(FindSweep, EverySweepIsFoundByItsName) {
  const auto names = sweep_names();
  ASSERT_GE(names.size(), 20U);
  for (const std::string& name : names) {
    EXPECT_NO_THROW(read_sweep(name, accel::registry())) << name;
  }
}

TEST(FindSweep, TheFormerFolderCausesAWarning) {
  testing::internal::CaptureStderr();
  const auto file = find_sweep("../harness/bench/sweeps/quick.json");
  EXPECT_EQ(file, find_sweep("quick"));
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "beambench: ../harness/bench/sweeps/quick.json has moved to harness/measure/sweeps; "
            "name it 'quick'\n");
}

TEST(FindSweep, AnUnknownNameListsTheOthers) {
  try {
    find_sweep("quik");
    FAIL();
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("did you mean 'quick'?"), std::string::npos) << message;
    EXPECT_NE(message.find("thesis/"), std::string::npos) << message;
  }
}

TEST(FindSweep, AFileIsUsedAsItIs) {
  const TemporaryFolder folder;
  const auto file = folder.write("own.json", "{}");
  EXPECT_EQ(find_sweep(file.string()), file);
}

}  // namespace
}  // namespace beambench::measure
