// Properties of messages: they mean the same in every process.

#include "harness/thesis/cluster/messages.hpp"

#include <set>
#include <span>
#include <string>
#include <variant>

#include <gtest/gtest.h>

#include "harness/thesis/cluster/job.hpp"
#include "harness/thesis/cluster/tasks.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/random.hpp"
#include "tests/random_scene.hpp"
#include "tests/thesis/cluster/beam_options.hpp"

namespace beambench::cluster {
namespace {

using tests::options_with;
using tests::random_scene;

/// Calls `visit(cursor)` for all leaves under the cursor.
template <class Visit>
void for_each_leaf(const accel::octree::OctreeCursor& cursor, Visit visit) {
  if (cursor.node().is_leaf()) {
    visit(cursor);
    return;
  }
  for (int octant = 0; octant < 8; ++octant) {
    const int half = cursor.size() / 2;
    accel::octree::OctreeCursor child = cursor;
    child.enter_child(cursor.corner() +
                      glm::ivec3(octant & 1, (octant >> 1) & 1, (octant >> 2) & 1) * half);
    for_each_leaf(child, visit);
  }
}

TEST(LeafCode, NamesEachLeafAndNothingElse) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const scenes::Scene scene = verify::random_scene(seed, 30);
    const accel::octree::Octree octree(scene, options_with(1 + static_cast<int>(seed)).octree);
    std::set<std::uint64_t> codes;
    for_each_leaf(accel::octree::OctreeCursor(octree),
                  [&](const accel::octree::OctreeCursor& leaf) {
                    const std::uint64_t code = leaf_code(octree, leaf.corner(), leaf.size());
                    EXPECT_TRUE(codes.insert(code).second);
                    const accel::octree::OctreeCursor found = find_leaf(octree, code);
                    EXPECT_EQ(found.index(), leaf.index());
                    EXPECT_EQ(found.corner(), leaf.corner());
                    EXPECT_EQ(found.size(), leaf.size());
                    EXPECT_THROW(find_leaf(octree, 8 * code), ProtocolError);  // below a leaf
                    EXPECT_THROW(find_leaf(octree, 2 * code), ProtocolError);
                    if (code > 1) {  // an inner node
                      EXPECT_THROW(find_leaf(octree, code / 8), ProtocolError);
                    }
                  });
    EXPECT_THROW(find_leaf(octree, 0), ProtocolError);
  }
}

bool same_line(const accel::beam::ImageLine& a, const accel::beam::ImageLine& b) {
  // -0 and 0 count as equal: the program only compares with a zero and never divides by it.
  return a.x == b.x && a.y == b.y && a.constant == b.constant;
}

bool same_plane(const accel::beam::Crossing& a, const accel::beam::Crossing& b) {
  return a.index == b.index && a.axis == b.axis && a.side == b.side;
}

void expect_same(const accel::beam::Beam& a, const accel::beam::Beam& b) {
  EXPECT_EQ(a.node, b.node);
  EXPECT_EQ(a.size, b.size);
  EXPECT_EQ(a.corner, b.corner);
  ASSERT_EQ(a.outline.size(), b.outline.size());
  for (std::size_t i = 0; i < a.outline.size(); ++i) EXPECT_EQ(a.outline[i], b.outline[i]);
  ASSERT_EQ(a.cuts.size(), b.cuts.size());
  for (std::size_t i = 0; i < a.cuts.size(); ++i) {
    EXPECT_TRUE(same_plane(a.cuts[i].first, b.cuts[i].first));
    EXPECT_TRUE(same_plane(a.cuts[i].second, b.cuts[i].second));
    EXPECT_TRUE(same_line(a.cuts[i].line, b.cuts[i].line));
  }
}

TEST(TaskMessage, RestoresABeamBitForBit) {
  std::size_t beams = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const scenes::Scene scene = verify::random_scene(seed, 40);
    const accel::beam::BeamTracer tracer(scene, options_with(5));
    const accel::PrimaryRays rays(scene.cameras.front(), 64, 48, 1);
    const accel::beam::EyeView view(tracer.octree().grid(), rays);
    accel::beam::BeamQueue queue;
    accel::beam::begin_beams(tracer.octree(), view, view.screen(), queue);
    accel::beam::BeamStep step;
    while (!queue.waiting.empty()) {
      queue.waiting.pop(step);
      if (step.kind == accel::BeamKind::kLeaving) continue;
      Bytes bytes;
      write_task({BeamTask::Kind::kTestLeaf, step.beam}, tracer.octree(), bytes);
      const auto task = read_task(bytes, tracer.octree(), view);
      ASSERT_TRUE(std::holds_alternative<BeamTask>(task));
      expect_same(std::get<BeamTask>(task).beam, step.beam);
      EXPECT_LT(bytes.size(), 1000U);
      ++beams;
      if (step.kind == accel::BeamKind::kNonTerminal && !step.beam.crowded()) {
        accel::beam::continue_beam(tracer.octree(), view, step.beam, queue);
      }
    }
  }
  EXPECT_GT(beams, 1000U);
}

TEST(TaskMessage, RefusesInvalidTasks) {
  const scenes::Scene scene = verify::random_scene(3, 40);
  const accel::beam::BeamTracer tracer(scene, options_with(5));
  const accel::PrimaryRays rays(scene.cameras.front(), 64, 48, 1);
  const accel::beam::EyeView view(tracer.octree().grid(), rays);
  BeamSource source(tracer, rays);
  Bytes task;
  ASSERT_TRUE(source.next(task));
  for (std::size_t length = 0; length < task.size(); ++length) {
    EXPECT_THROW(read_task(std::span(task).first(length), tracer.octree(), view), ProtocolError);
  }
  Random random(1);
  for (int i = 0; i < 20000; ++i) {  // any input is refused or read as a beam, without a crash
    Bytes spoilt = task;
    const std::size_t at = random.below(static_cast<std::uint32_t>(task.size()));
    spoilt[at] = static_cast<std::byte>(random.below(256));
    try {
      read_task(spoilt, tracer.octree(), view);
    } catch (const ProtocolError&) {
      continue;
    }
  }
}

TEST(BlockTask, ComesBack) {
  const scenes::Scene scene = verify::random_scene(3, 10);
  const accel::beam::BeamTracer tracer(scene, options_with(3));
  const accel::PrimaryRays rays(scene.cameras.front(), 64, 48, 1);
  const accel::beam::EyeView view(tracer.octree().grid(), rays);
  Bytes bytes;
  write_task(BlockTask{{1, 16383, 3, 4}}, bytes);
  const auto block = std::get<BlockTask>(read_task(bytes, tracer.octree(), view));
  EXPECT_EQ(block.left, 1);
  EXPECT_EQ(block.top, 16383);
  EXPECT_EQ(block.width, 3);
  EXPECT_EQ(block.height, 4);
}

TEST(Parcel, HoldsItsItemsInTheirOrder) {
  ParcelWriter writer(7);
  for (int i = 0; i < 5; ++i) {
    ByteWriter(writer.begin_item()).put_text(std::string(static_cast<std::size_t>(i), 'x'));
    if (i == 2) {
      writer.drop_item();
    } else {
      writer.end_item(static_cast<float>(i));
    }
  }
  EXPECT_EQ(writer.items(), 4U);
  Bytes bytes = std::move(writer).take();
  const ParcelReader reader(bytes);
  EXPECT_EQ(reader.number(), 7U);
  ASSERT_EQ(reader.items().size(), 4U);
  EXPECT_EQ(reader.items()[2].note, 3.0F);
  EXPECT_EQ(ByteReader(reader.items()[2].bytes).get_text(), "xxx");
  bytes.pop_back();
  EXPECT_THROW(ParcelReader{bytes}, ProtocolError);
}

TEST(JobMessage, ComesBack) {
  Job job;
  job.scene = "balls:n=2";
  job.structure = "beam:max_level=5";
  job.camera = "side";
  job.resolution = {30, 20};
  job.samples = 5;
  job.light = true;
  job.whitted = {3, 0.25, render::ShadowMethod::kCache};
  job.heartbeat_interval = 0.5;
  const Job read = read_job(write_job(job));
  EXPECT_EQ(read.scene, job.scene);
  EXPECT_EQ(read.structure, job.structure);
  EXPECT_EQ(read.camera, job.camera);
  EXPECT_EQ(read.resolution, (rays::Resolution{30, 20}));
  EXPECT_EQ(read.samples, 5);
  EXPECT_TRUE(read.light);
  EXPECT_EQ(read.whitted.max_depth, 3);
  EXPECT_EQ(read.whitted.min_weight, 0.25);
  EXPECT_EQ(read.whitted.shadows, render::ShadowMethod::kCache);
  EXPECT_EQ(read.heartbeat_interval, 0.5);
}

/// Returns the message that reading throws; empty if it does not throw.
template <class Read>
std::string problem_of(Read read) {
  try {
    read();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// Turns a message into one of another version by changing a letter of the version.
Bytes from_another_version(Bytes bytes) {
  bytes[8] = static_cast<std::byte>('9');
  return bytes;
}

TEST(ReadyReport, IsRefusedUnlessTheProcessMatches) {
  const Identity mine{1, 2, 3, 4};
  ReadyReport ready_report{"node7", "", mine, 0.5, 100};
  const auto problem = [&](const Bytes& bytes) {
    return problem_of([&] { read_ready_report(4, bytes, mine); });
  };
  EXPECT_EQ(problem(write_ready_report(ready_report)), "");
  EXPECT_NE(problem(from_another_version(write_ready_report(ready_report)))
                .find("process 4 on node7 is version"),
            std::string::npos);
  ready_report.identity.primitives = 9;
  EXPECT_NE(problem(write_ready_report(ready_report)).find("9 primitives"), std::string::npos);
  ready_report.identity.references = 9;
  EXPECT_NE(problem(write_ready_report(ready_report)).find("a different octree"),
            std::string::npos);
  ready_report.identity.scene = 5;
  EXPECT_NE(problem(write_ready_report(ready_report)).find("a different scene"), std::string::npos);
  ready_report.problem = "there is no scene 'x'";
  EXPECT_EQ(problem(write_ready_report(ready_report)), "process 4 on node7: there is no scene 'x'");
  EXPECT_NE(problem(Bytes(40)).find("a different program"), std::string::npos);
}

TEST(JobMessage, OfAnotherVersionIsRefused) {
  const Bytes bytes = from_another_version(write_job({}));
  EXPECT_NE(problem_of([&] { read_job(bytes); }).find("but the producer is version 9"),
            std::string::npos);
}

TEST(LookHash, DependsOnEverythingThatAffectsThePicture) {
  const scenes::Scene scene = verify::random_scene(5, 10);
  const std::uint64_t before = visible_hash(scene);
  EXPECT_EQ(visible_hash(scene), before);
  scenes::Scene other = scene;
  other.lights.push_back({glm::vec3(1.0F), glm::vec3(1.0F)});
  EXPECT_NE(visible_hash(other), before);
  other = scene;
  other.surfaces.front().diffuse += 0.25F;
  EXPECT_NE(visible_hash(other), before);
  other = scene;
  other.background.x += 0.25F;
  EXPECT_NE(visible_hash(other), before);
  other = scene;
  other.cameras.front().angle += 1.0F;
  EXPECT_NE(visible_hash(other), before);
}

}  // namespace
}  // namespace beambench::cluster
