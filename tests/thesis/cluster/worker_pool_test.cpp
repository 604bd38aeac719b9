// Properties of the pool: the process that has waited longest is next, and silence is detected.

#include "harness/thesis/cluster/worker_pool.hpp"

#include <gtest/gtest.h>

namespace beambench::cluster {
namespace {

using Processes = std::vector<ProcessId>;

TEST(WorkerPool, AssignsToTheLongestWaiting) {
  WorkerPool pool(4, 1, 10.0);
  EXPECT_TRUE(pool.nobody_present());
  EXPECT_EQ(pool.longest_waiting(), std::nullopt);
  pool.join(2, 0.0);
  pool.join(1, 0.0);
  pool.join(3, 0.0);
  EXPECT_EQ(pool.longest_waiting(), 2);
  pool.gave(2, 1.0);
  EXPECT_EQ(pool.longest_waiting(), 1);
  pool.gave(1, 1.0);
  pool.gave(3, 1.0);
  EXPECT_EQ(pool.longest_waiting(), std::nullopt);
  pool.returned(3, 2.0);
  pool.returned(2, 3.0);
  EXPECT_EQ(pool.longest_waiting(), 3);
  EXPECT_TRUE(pool.idle(3));
  EXPECT_FALSE(pool.idle(1));
}

TEST(WorkerPool, ServesIdleConsumersBeforeSecondParcels) {
  WorkerPool pool(3, 2, 10.0);
  pool.join(1, 0.0);
  pool.join(2, 0.0);
  Processes given;
  while (const auto next = pool.longest_waiting()) {
    given.push_back(*next);
    pool.gave(*next, 1.0);
  }
  EXPECT_EQ(given, (Processes{1, 2, 1, 2}));
  pool.returned(2, 2.0);  // 2 has one left
  pool.returned(1, 2.0);
  pool.returned(1, 2.0);  // 1 has none
  EXPECT_EQ(pool.longest_waiting(), 1);
}

TEST(WorkerPool, DetectsSilentConsumersWithWork) {
  WorkerPool pool(3, 1, 10.0);
  pool.join(1, 0.0);
  pool.join(2, 0.0);
  EXPECT_EQ(pool.next_deadline(), Transport::kForever);  // a process without work may be silent
  pool.gave(1, 100.0);
  EXPECT_EQ(pool.next_deadline(), 110.0);
  EXPECT_EQ(pool.declare_silent_lost(110.0), Processes{});
  pool.heard(1, 109.0);
  EXPECT_EQ(pool.declare_silent_lost(119.0), Processes{});
  EXPECT_EQ(pool.declare_silent_lost(119.5), Processes{1});
  EXPECT_EQ(pool.lost(), Processes{1});
  EXPECT_EQ(pool.present(), Processes{2});
  EXPECT_EQ(pool.declare_silent_lost(1000.0), Processes{});
}

TEST(WorkerPool, ReadmitsConsumersThatAnswerAgain) {
  WorkerPool pool(2, 1, 10.0);
  pool.join(1, 0.0);
  pool.gave(1, 0.0);
  EXPECT_EQ(pool.declare_silent_lost(11.0), Processes{1});
  EXPECT_TRUE(pool.nobody_present());
  pool.heard(1, 12.0);
  EXPECT_EQ(pool.present(), Processes{1});
  EXPECT_EQ(pool.longest_waiting(), std::nullopt);  // it still has its parcel
  pool.returned(1, 13.0);
  EXPECT_EQ(pool.longest_waiting(), 1);
}

TEST(WorkerPool, ForgetsShutDownConsumers) {
  WorkerPool pool(3, 1, 10.0);
  pool.join(1, 0.0);
  pool.shut_down(1);
  EXPECT_EQ(pool.longest_waiting(), std::nullopt);
  pool.join(1, 1.0);
  pool.heard(1, 1.0);
  EXPECT_TRUE(pool.nobody_present());
  EXPECT_EQ(pool.not_shut_down(), Processes{2});
}

}  // namespace
}  // namespace beambench::cluster
