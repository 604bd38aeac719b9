// The processor time of other processes.

#include "harness/measure/record/other_work.hpp"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/measure/record/conditions.hpp"
#include "tests/temporary_folder.hpp"

namespace beambench::measure {
namespace {

using std::chrono::milliseconds;

/// Writes a /proc/stat in which the processors worked this long, in hundredths of a second.
void write_stat(const std::filesystem::path& root, int user, int idle) {
  std::filesystem::create_directories(root / "proc");
  std::ofstream(root / "proc/stat") << "cpu  " << user << " 10 20 " << idle << " 30 40 50 60 0 0\n"
                                    << "cpu0 1 2 3 4 5 6 7 8 0 0\n";
}

TEST(OtherWork, IsTheTimeOfAllProcessorsWithoutOurOwn) {
  const TemporaryFolder root;
  write_stat(root.path(), 1000, 5000);
  const auto begin = std::chrono::steady_clock::now();
  const OtherWork other(root.path());
  std::this_thread::sleep_for(milliseconds(500));
  write_stat(root.path(), 1100, 9000);
  const double processors = other.processors().value();
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
  EXPECT_NEAR(processors * passed.count(), 1.0, 0.1) << "a second of work, by any number of them";
}

TEST(OtherWork, IsUnknownForAShortTimeAndWithoutTheKernelsCount) {
  EXPECT_EQ(OtherWork().processors(), std::nullopt);
  const TemporaryFolder root;
  const OtherWork other(root.path());
  std::this_thread::sleep_for(milliseconds(450));
  EXPECT_EQ(other.processors(), std::nullopt);
}

TEST(OtherWork, SeesAnotherProcess) {
  const OtherWork other;
  const ::pid_t child = ::fork();
  if (child == 0) {
    for (;;) ::getppid();
  }
  std::this_thread::sleep_for(milliseconds(800));
  EXPECT_GT(other.processors().value(), 0.2);
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
}

TEST(OtherWork, IsDescribedIfItDisturbs) {
  EXPECT_EQ(describe_other_work(std::nullopt), std::nullopt);
  EXPECT_EQ(describe_other_work(kQuiet), std::nullopt);
  EXPECT_EQ(describe_other_work(0.8), "other work kept 0.80 processors busy");
}

TEST(OtherWork, IsTheLoadBesidesTheRunInOlderRecords) {
  const auto other_work = [](double before, const nlohmann::ordered_json& highest) {
    nlohmann::ordered_json measurement{{"noise", nullptr}, {"threads", 2}};
    if (!highest.is_null()) measurement["highest_load"] = highest;
    return conditions_of({{"machine", {{"load_average", before}}}, {"measurement", measurement}})
        .other_work;
  };
  EXPECT_EQ(other_work(0.5, nullptr), 0.0);
  EXPECT_EQ(other_work(1.5, nullptr), 1.5);
  EXPECT_EQ(other_work(0.1, 2.5), 0.0);
  EXPECT_EQ(other_work(0.1, 5.0), 3.0);
}

}  // namespace
}  // namespace beambench::measure
