// What must be true of the crew: the one that waited longest is next, and silence is noticed.

#include "harness/cluster/crew.hpp"

#include <gtest/gtest.h>

namespace beambench::cluster {
namespace {

using Processes = std::vector<ProcessId>;

TEST(Crew, GivesToTheOneThatWaitedLongest) {
  Crew crew(4, 1, 10.0);
  EXPECT_TRUE(crew.nobody_present());
  EXPECT_EQ(crew.longest_waiting(), std::nullopt);
  crew.join(2, 0.0);
  crew.join(1, 0.0);
  crew.join(3, 0.0);
  EXPECT_EQ(crew.longest_waiting(), 2);
  crew.gave(2, 1.0);
  EXPECT_EQ(crew.longest_waiting(), 1);
  crew.gave(1, 1.0);
  crew.gave(3, 1.0);
  EXPECT_EQ(crew.longest_waiting(), std::nullopt);
  crew.returned(3, 2.0);
  crew.returned(2, 3.0);
  EXPECT_EQ(crew.longest_waiting(), 3);
  EXPECT_TRUE(crew.idle(3));
  EXPECT_FALSE(crew.idle(1));
}

TEST(Crew, FillsIdleConsumersBeforeOthersGetASecondParcel) {
  Crew crew(3, 2, 10.0);
  crew.join(1, 0.0);
  crew.join(2, 0.0);
  Processes given;
  while (const auto next = crew.longest_waiting()) {
    given.push_back(*next);
    crew.gave(*next, 1.0);
  }
  EXPECT_EQ(given, (Processes{1, 2, 1, 2}));
  crew.returned(2, 2.0);  // 2 has one left
  crew.returned(1, 2.0);
  crew.returned(1, 2.0);  // 1 has none
  EXPECT_EQ(crew.longest_waiting(), 1);
}

TEST(Crew, NoticesSilenceOfThoseThatHaveWork) {
  Crew crew(3, 1, 10.0);
  crew.join(1, 0.0);
  crew.join(2, 0.0);
  EXPECT_EQ(crew.next_deadline(), Transport::kForever);  // who has no work may be silent
  crew.gave(1, 100.0);
  EXPECT_EQ(crew.next_deadline(), 110.0);
  EXPECT_EQ(crew.give_up_silent(110.0), Processes{});
  crew.heard(1, 109.0);
  EXPECT_EQ(crew.give_up_silent(119.0), Processes{});
  EXPECT_EQ(crew.give_up_silent(119.5), Processes{1});
  EXPECT_EQ(crew.lost(), Processes{1});
  EXPECT_EQ(crew.present(), Processes{2});
  EXPECT_EQ(crew.give_up_silent(1000.0), Processes{});
}

TEST(Crew, TakesBackWhoIsHeardAgain) {
  Crew crew(2, 1, 10.0);
  crew.join(1, 0.0);
  crew.gave(1, 0.0);
  EXPECT_EQ(crew.give_up_silent(11.0), Processes{1});
  EXPECT_TRUE(crew.nobody_present());
  crew.heard(1, 12.0);
  EXPECT_EQ(crew.present(), Processes{1});
  EXPECT_EQ(crew.longest_waiting(), std::nullopt);  // it still has its parcel
  crew.returned(1, 13.0);
  EXPECT_EQ(crew.longest_waiting(), 1);
}

TEST(Crew, ForgetsWhoWasSentHome) {
  Crew crew(3, 1, 10.0);
  crew.join(1, 0.0);
  crew.dismiss(1);
  EXPECT_EQ(crew.longest_waiting(), std::nullopt);
  crew.join(1, 1.0);
  crew.heard(1, 1.0);
  EXPECT_TRUE(crew.nobody_present());
  EXPECT_EQ(crew.not_dismissed(), Processes{2});
}

}  // namespace
}  // namespace beambench::cluster
