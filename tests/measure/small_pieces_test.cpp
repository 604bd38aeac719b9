// Resolutions, kinds of rays and progress.

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "harness/base/progress.hpp"
#include "harness/rays/ray_kind.hpp"
#include "harness/rays/trace_input.hpp"
#include "scenes/base/error.hpp"

namespace beambench::measure {
namespace {

RC_GTEST_PROP(Resolution, ReadsBackWhatItPrints, ()) {
  const rays::Resolution resolution{*rc::gen::inRange(1, rays::Resolution::kMaxSide + 1),
                                    *rc::gen::inRange(1, rays::Resolution::kMaxSide + 1)};
  RC_ASSERT(rays::parse_resolution(rays::to_string(resolution)) == resolution);
}

TEST(Resolution, IsTwoWholeNumbersInRange) {
  for (const char* text : {"", "x", "640", "640x", "x480", "0x0", "-1x5", "99999x99999", "1e3x3",
                           "640X480", "640x480x3", " 640x480", "640x480 ", "nanx1"}) {
    EXPECT_THROW(rays::parse_resolution(text), InputError) << text;
  }
}

TEST(RayCount, IsLimitedByPixelsTimesSamples) {
  EXPECT_NO_THROW(rays::require_ray_count({16384, 16384}, 1));
  EXPECT_THROW(rays::require_ray_count({16384, 16384}, 4), InputError);
}

TEST(RayKinds, AreReadFromAListWithoutDuplicates) {
  EXPECT_EQ(rays::parse_ray_choices("primary,primary"), std::vector{rays::RayChoice()});
  const auto choices =
      rays::parse_ray_choices("shadow,diffuse:seed=7,diffuse,a/b.rays,diffuse:seed=1");
  ASSERT_EQ(choices.size(), 4U);
  EXPECT_EQ(choices[1].label, "diffuse:seed=7");
  EXPECT_EQ(choices[1].seed, 7U);
  EXPECT_EQ(choices[2].label, "diffuse");
  EXPECT_EQ(choices[3].file, "a/b.rays");
  const auto scattered = rays::parse_ray_choices("ao:samples=4,seed=2,path:bounces=4,seed=1");
  ASSERT_EQ(scattered.size(), 2U);
  EXPECT_EQ(scattered[0].label, "ao:samples=4,seed=2");
  EXPECT_EQ(rays::parameters_of(scattered[0]).integer("samples"), 4);
  EXPECT_EQ(scattered[1].label, "path");
  const auto pictures = rays::parse_ray_choices("whitted,whitted:shadows=cache,depth=3,shadow");
  ASSERT_EQ(pictures.size(), 3U);
  EXPECT_EQ(pictures[0].label, "whitted");
  EXPECT_EQ(pictures[1].label, "whitted:depth=3,shadows=cache");
  EXPECT_EQ(pictures[2].label, "shadow");
  for (const char* text :
       {"", "primary,", ",primary", "Primary", "shadows", "shadow:seed=1", "diffuse:seed=x",
        "diffuse:seed=-1", "ao:samples=0", "ao:samples=1025", "ao:distance=0", "ao:distance=-1",
        "ao:distance=nan", "path:bounces=0", "whitted:batch=63", "whitted:batch=524289"}) {
    EXPECT_THROW(rays::parse_ray_choices(text), InputError) << text;
  }
}

/// Returns the output of a Progress on a stream that is treated as a terminal if `terminal` is set.
template <class Work>
std::string written(bool terminal, Work work) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::tmpfile(), &std::fclose);
  {
    base::Progress progress(2, stream.get(), terminal);
    work(progress);
  }
  std::string text(static_cast<std::size_t>(std::ftell(stream.get())), '\0');
  std::rewind(stream.get());
  EXPECT_EQ(std::fread(text.data(), 1, text.size(), stream.get()), text.size());
  return text;
}

void two_cells(base::Progress& progress) {
  progress.start("first");
  progress.advance(0.5);
  progress.finish("ok");
  progress.start("second");
  progress.finish("mismatch");
}

TEST(Progress, IsOneLinePerCellWithoutATerminal) {
  EXPECT_EQ(written(false, two_cells), "[1/2] first: ok\n[2/2] second: mismatch\n");
}

TEST(Progress, IsARedrawnLineOnATerminalAndIsRemovedAtTheEnd) {
  const std::string text = written(true, two_cells);
  EXPECT_EQ(text.find('\n'), std::string::npos);
  EXPECT_NE(text.find("1/2  estimating  first"), std::string::npos) << text;
  EXPECT_NE(text.find("50%  2/2"), std::string::npos) << text;
  EXPECT_NE(text.find(" left  second"), std::string::npos) << text;
  EXPECT_TRUE(text.ends_with("\r\033[K"));
}

TEST(Progress, ThatCannotBeWrittenIsIgnored) {
  for (const bool terminal : {false, true}) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> full(std::fopen("/dev/full", "w"),
                                                               &std::fclose);
    ASSERT_TRUE(full);
    base::Progress progress(2, full.get(), terminal);
    EXPECT_NO_THROW(two_cells(progress));
    EXPECT_NO_THROW(progress.say("a warning"));
  }
}

TEST(Progress, StaysWithinOneLineOfTheTerminal) {
  const std::string name(300, 'x');
  const std::string text = written(true, [&](base::Progress& progress) { progress.start(name); });
  EXPECT_LT(std::count(text.begin(), text.end(), 'x'), 80);
  EXPECT_GT(std::count(text.begin(), text.end(), 'x'), 40);
}

TEST(Progress, EstimatesFromThePaceSoFar) {
  EXPECT_DOUBLE_EQ(base::remaining_seconds(10.0, 0.25), 30.0);
  EXPECT_DOUBLE_EQ(base::remaining_seconds(10.0, 1.0), 0.0);
}

TEST(Progress, DurationsAreReadable) {
  EXPECT_EQ(base::format_duration(0.04), "0.0 s");
  EXPECT_EQ(base::format_duration(9.94), "9.9 s");
  EXPECT_EQ(base::format_duration(59.2), "59 s");
  EXPECT_EQ(base::format_duration(200.0), "3 min 20 s");
  EXPECT_EQ(base::format_duration(7500.0), "2 h 5 min");
}

}  // namespace
}  // namespace beambench::measure
