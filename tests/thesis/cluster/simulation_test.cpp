// Properties of a simulation's parts: recorded costs, tasks replayed in order, and the time that
// messages cost.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/thesis/cluster/image_division.hpp"
#include "harness/thesis/cluster/simulation/replay.hpp"
#include "scenes/base/error.hpp"
#include "tests/temporary_folder.hpp"
#include "tests/thesis/cluster/local_network.hpp"

namespace beambench::cluster {
namespace {

TaskCosts two_tasks() {
  TaskCosts costs;
  costs.tasks = {{0.1, 1.0, 0.01, 150, 800, 100}, {0.2, 2.0, 0.02, 2, 3, 7}};
  costs.last_walk_seconds = 0.4;
  return costs;
}

/// Records the time spent.
struct Purse {
  std::vector<double> spent;
  Spend spend() {
    return [this](double seconds) { spent.push_back(seconds); };
  }
};

TEST(TaskCosts, AreReadByTheNamesOfTheirColumns) {
  const TemporaryFolder folder;
  const TaskCosts costs = read_task_costs(
      folder.write("costs.csv",
                   "samples,task,work_seconds,other,walk_seconds,accept_seconds,task_bytes,"
                   "result_bytes\r\n"
                   "100,0,1.5,x,0.25,1e-3,150,800\r\n"
                   "0,end,0,x,0.5,0,0,0\r\n"));
  ASSERT_EQ(costs.tasks.size(), 1U);
  EXPECT_EQ(costs.tasks[0].walk_seconds, 0.25);
  EXPECT_EQ(costs.tasks[0].work_seconds, 1.5);
  EXPECT_EQ(costs.tasks[0].accept_seconds, 1e-3);
  EXPECT_EQ(costs.tasks[0].task_bytes, 150U);
  EXPECT_EQ(costs.tasks[0].result_bytes, 800U);
  EXPECT_EQ(costs.tasks[0].samples, 100U);
  EXPECT_EQ(costs.last_walk_seconds, 0.5);
}

TEST(TaskCosts, AreScaledByTheWork) {
  const TaskCosts slow = slowed(two_tasks(), 10.0, 100.0);
  EXPECT_DOUBLE_EQ(slow.walk_seconds(), 10.0 * (0.1 + 0.2 + 0.4));
  EXPECT_DOUBLE_EQ(slow.work_seconds(), 100.0 * (1.0 + 2.0));
  EXPECT_DOUBLE_EQ(slow.accept_seconds(), 100.0 * (0.01 + 0.02));
  EXPECT_EQ(slow.tasks[0].result_bytes, 800U);
}

TEST(TaskCosts, HaveWholeBytesForSamples) {
  const TaskCosts costs = with_results_of(1.6, two_tasks());
  EXPECT_EQ(costs.tasks[0].result_bytes, 160U);
  EXPECT_EQ(costs.tasks[1].result_bytes, 12U);  // 11.2
  EXPECT_EQ(costs.tasks[1].task_bytes, 2U);
}

TEST(Replay, RunsTheTasksInOrderAndTakesTheirTime) {
  const TaskCosts costs = two_tasks();
  Purse purse;
  ReplayedSource source(costs, purse.spend());
  Bytes first;
  Bytes second;
  Bytes none;
  EXPECT_TRUE(source.next(first));
  EXPECT_TRUE(source.next(second));
  EXPECT_FALSE(source.next(none));
  EXPECT_EQ(first.size(), 150U);
  EXPECT_EQ(second.size(), 4U);  // its number needs this many bytes
  EXPECT_TRUE(none.empty());
  EXPECT_EQ(purse.spent, (std::vector<double>{0.1, 0.2, 0.4}));
}

TEST(Replay, UsesTheMeasuredTimeOfEachTaskInAnyOrder) {
  const TaskCosts costs = two_tasks();
  Purse purse;
  ReplayedSource source(costs, [](double) {});
  std::vector<Bytes> tasks(2);
  for (Bytes& task : tasks) source.next(task);
  ReplayedWorker worker(costs, purse.spend());
  ReplayedSink sink(costs, purse.spend());
  std::vector<Bytes> results(2);
  for (const std::size_t i : {1U, 0U}) worker.perform(tasks[i], results[i], [] {});
  EXPECT_EQ(results[0].size(), 800U);
  EXPECT_EQ(results[1].size(), 4U);
  EXPECT_EQ(sink.accept(results[0]), 100U);
  EXPECT_EQ(sink.accept(results[1]), 7U);
  EXPECT_EQ(purse.spent, (std::vector<double>{2.0, 1.0, 0.01, 0.02}));
  EXPECT_THROW(sink.accept(results[0]), ProtocolError);  // came before
}

TEST(Replay, RefusesAnInvalidTask) {
  const TaskCosts costs = two_tasks();
  ReplayedWorker worker(costs, [](double) {});
  Bytes result;
  Bytes third;
  ByteWriter(third).put(std::uint32_t{2});
  EXPECT_THROW(worker.perform(third, result, [] {}), ProtocolError);
  EXPECT_THROW(worker.perform(Bytes(2), result, [] {}), ProtocolError);
}

TEST(Replay, SendsThePlanAfterThePrePass) {
  TaskCosts costs = two_tasks();
  costs.tasks.push_back({0.3, 3.0, 0.03, 10, 11, 5});
  Purse purse;
  ReplayedSource source(costs, purse.spend(), {{2, 0}, {1}}, 7.0);
  EXPECT_EQ(source.parcel_size(), 2U);
  std::vector<Bytes> tasks(3);
  for (Bytes& task : tasks) EXPECT_TRUE(source.next(task));
  EXPECT_EQ(source.parcel_size(), 0U);
  EXPECT_FALSE(source.next(tasks[0]));
  EXPECT_EQ(purse.spent, (std::vector<double>{7.0, 0.3, 0.1, 0.2, 0.4}));
}

TEST(Replay, OfARangeOfTilesSumsTheirTimes) {
  const TaskCosts sent = merged(two_tasks(), {{0, 1}}, false);
  ASSERT_EQ(sent.tasks.size(), 1U);
  EXPECT_DOUBLE_EQ(sent.work_seconds(), 3.0);
  EXPECT_DOUBLE_EQ(sent.accept_seconds(), 0.03);
  EXPECT_EQ(sent.tasks[0].result_bytes, 803U);
  EXPECT_EQ(sent.tasks[0].samples, 107U);
  EXPECT_EQ(sent.tasks[0].task_bytes, 150U);
  const TaskCosts stored = merged(two_tasks(), {{0, 1}}, true);
  EXPECT_DOUBLE_EQ(stored.work_seconds(), 3.0);
  EXPECT_DOUBLE_EQ(stored.accept_seconds(), 0.01);
  EXPECT_EQ(stored.tasks[0].result_bytes, 800U);
}

TEST(Replay, NeedsEstimatesForSharesOfEqualCost) {
  TaskCosts costs = two_tasks();
  EXPECT_THROW(planned(ImageDivision::kEqualCost, costs, 2), InputError);
  costs.tasks[1].estimate_seconds = 1.0;
  EXPECT_EQ(planned(ImageDivision::kEqualCost, costs, 2), (std::vector<Share>{{1}, {0}}));
}

TEST(ChargedTransport, ChargesSenderReceiverAndPolling) {
  LocalNetwork network(2, 1, 0.0);
  Purse sender;
  Purse receiver;
  const MessageCost cost{1.0, 0.25, 0.125};
  ChargedTransport from(network.at(0), cost, sender.spend());
  ChargedTransport to(network.at(1), cost, receiver.spend());
  EXPECT_FALSE(to.poll());
  from.send(1, Tag::kTasks, Bytes(8));
  EXPECT_TRUE(to.wait(10.0));
  from.send(1, Tag::kEnd, {});
  EXPECT_TRUE(to.wait(10.0));
  EXPECT_FALSE(to.wait(0.0));  // a waiting process does nothing else
  EXPECT_EQ(sender.spent, (std::vector<double>{3.0, 1.0}));
  EXPECT_EQ(receiver.spent, (std::vector<double>{0.125, 3.0, 1.0}));
}

}  // namespace
}  // namespace beambench::cluster
