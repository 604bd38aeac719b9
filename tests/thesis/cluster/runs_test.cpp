// Properties of whole runs: the image is the sequential one bit for bit, for any number of
// processes, any order of messages, and any process that falls silent.

#include <functional>
#include <optional>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "accel/beam/beam_tracer.hpp"
#include "harness/rays/fingerprint.hpp"
#include "harness/render/shading.hpp"
#include "harness/render/whitted_picture.hpp"
#include "harness/thesis/cluster/consumer.hpp"
#include "harness/thesis/cluster/image_division.hpp"
#include "harness/thesis/cluster/image_worker.hpp"
#include "harness/thesis/cluster/producer.hpp"
#include "harness/thesis/cluster/run.hpp"
#include "harness/thesis/cluster/tasks.hpp"
#include "scenes/base/error.hpp"
#include "scenes/catalogue.hpp"
#include "tests/random_scene.hpp"
#include "tests/thesis/cluster/beam_options.hpp"
#include "tests/thesis/cluster/followers.hpp"
#include "tests/thesis/cluster/local_network.hpp"

namespace beambench::cluster {
namespace {

using tests::options_with;
using tests::random_scene;

void accept_anybody(ProcessId, std::span<const std::byte>) {}

/// An image made by all processes of a network.
class Workplace {
 public:
  Workplace(const scenes::Scene& scene, const accel::beam::BeamOptions& options, int samples)
      : tracer_(scene, options),
        rays_(scene.cameras.front(), 53, 41, samples),
        light_(scene, tracer_, {}) {}

  accel::HitBuffer sequential_hits() const {
    accel::HitBuffer hits(rays_.width(), rays_.height(), rays_.samples());
    tracer_.closest_hits(rays_, hits, {});
    return hits;
  }
  render::Image sequential_picture() const {
    return render::whitted_picture(light_, rays_, sequential_hits()).image;
  }

  ClusterReport hits(LocalNetwork& network, int processes, const ProducerOptions& options,
                     accel::HitBuffer& hits, std::optional<int> block = {}) const {
    HitSink sink(hits);
    return run(network, processes, options, sink, nullptr, block);
  }
  render::Image picture(LocalNetwork& network, int processes,
                        const ProducerOptions& options) const {
    ColorSink sink(rays_.width(), rays_.height(), rays_.samples(),
                   glm::dvec3(render::background_color(tracer_.scene())));
    run(network, processes, options, sink, &light_, {});
    return sink.image();
  }
  accel::HitBuffer no_hits() const { return {rays_.width(), rays_.height(), rays_.samples()}; }

 private:
  ClusterReport run(LocalNetwork& network, int processes, const ProducerOptions& options,
                    ResultSink& sink, const render::Whitted* light,
                    std::optional<int> block) const {
    std::vector<std::jthread> consumers;
    for (ProcessId process = 1; process < processes; ++process) {
      consumers.emplace_back([this, process, light, &network] {
        ImageWorker worker(tracer_, rays_, light);
        consume(network.at(process), worker, 0.01, {});
      });
    }
    std::unique_ptr<TaskSource> source = std::make_unique<BeamSource>(tracer_, rays_);
    if (block) source = std::make_unique<BlockSource>(rays_.width(), rays_.height(), *block);
    ImageWorker own(tracer_, rays_, light);
    return Producer(network.at(kProducer), *source, sink, own, accept_anybody, options).run();
  }

  accel::beam::BeamTracer tracer_;
  accel::PrimaryRays rays_;
  render::Whitted light_;
};

bool same_picture(const render::Image& a, const render::Image& b) {
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) {
      if (a.at(x, y) != b.at(x, y)) return false;
    }
  }
  return true;
}

TEST(Cluster, FindsTheSequentialHitsForAnyOrderOfMessages) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    const scenes::Scene scene = verify::random_scene(seed, 40);
    const Workplace place(scene, options_with(5, seed % 2 == 0 ? 0 : 60), seed % 2 == 0 ? 1 : 5);
    const accel::HitBuffer expected = place.sequential_hits();
    for (const int processes : {1, 2, 3, 6}) {
      LocalNetwork network(processes, seed, 0.0003);
      accel::HitBuffer hits = place.no_hits();
      const ClusterReport report = place.hits(network, processes, {}, hits);
      EXPECT_TRUE(hits == expected) << "seed " << seed << ", " << processes << " processes";
      EXPECT_TRUE(report.remarks.empty());
      EXPECT_TRUE(report.lost.empty());
    }
  }
}

TEST(Cluster, FindsTheSequentialHitsWithEveryOption) {
  const scenes::Scene scene = verify::random_scene(4, 60);
  const Workplace place(scene, options_with(5), 5);
  const accel::HitBuffer expected = place.sequential_hits();
  for (const std::size_t batch : {1, 3, 1000}) {
    for (const int in_flight : {1, 2, 3}) {
      for (const bool consumes : {false, true}) {
        for (const std::optional<int> block : {std::optional<int>{}, std::optional<int>{16}}) {
          LocalNetwork network(4, 1, 0.0003);
          accel::HitBuffer hits = place.no_hits();
          ProducerOptions options;
          options.batch = batch;
          options.in_flight = in_flight;
          options.consumes = consumes;
          place.hits(network, 4, options, hits, block);
          EXPECT_TRUE(hits == expected) << batch << ' ' << in_flight << ' ' << consumes;
        }
      }
    }
  }
}

TEST(Cluster, MakesTheSequentialPicture) {
  for (const char* name : {"balls:n=1", "rings:n=1", "escena1"}) {
    const scenes::Scene scene = scenes::load_scene(name);
    for (const int samples : {1, 5}) {
      const Workplace place(scene, options_with(5), samples);
      const render::Image expected = place.sequential_picture();
      for (const int processes : {1, 3}) {
        LocalNetwork network(processes, 2, 0.0003);
        EXPECT_TRUE(same_picture(place.picture(network, processes, {}), expected))
            << name << ", " << samples << " samples, " << processes << " processes";
      }
    }
  }
}

TEST(Cluster, ReportsTheWorkOfEachProcess) {
  const scenes::Scene scene = verify::random_scene(2, 40);
  const Workplace place(scene, options_with(5), 1);
  LocalNetwork network(3, 1, 0.0001);
  accel::HitBuffer hits = place.no_hits();
  const ClusterReport report = place.hits(network, 3, {}, hits);
  ASSERT_EQ(report.processes.size(), 3U);
  EXPECT_EQ(report.processes[0].tasks, 0U);
  EXPECT_EQ(report.processes[1].tasks + report.processes[2].tasks, report.tasks.size());
  std::size_t samples = 0;
  std::size_t task_bytes = 0;
  for (const TaskReport& task : report.tasks) {
    EXPECT_TRUE(task.process == 1 || task.process == 2);
    EXPECT_GT(task.work_seconds, 0.0);
    EXPECT_GT(task.task_bytes, 0U);
    samples += task.samples;
    task_bytes += task.task_bytes;
  }
  EXPECT_EQ(report.processes[1].samples + report.processes[2].samples, samples);
  for (const int consumer : {1, 2}) {
    const ProcessReport& process = report.processes[static_cast<std::size_t>(consumer)];
    EXPECT_EQ(process.from_producer.messages, process.tasks + 1);    // and the end
    EXPECT_EQ(process.to_producer.messages, process.tasks + 2);      // ready and final report
    task_bytes -= process.from_producer.bytes - 12 * process.tasks;  // number, length, note
  }
  EXPECT_EQ(task_bytes, 0U);
}

ProducerOptions impatient() {
  ProducerOptions options;
  options.timeout = 0.2;
  options.startup_timeout = 0.5;
  return options;
}

TEST(Cluster, ContinuesWithoutASilentConsumer) {
  const scenes::Scene scene = verify::random_scene(6, 60);
  const Workplace place(scene, options_with(5), 1);
  const accel::HitBuffer expected = place.sequential_hits();
  for (const int answers : {0, 1, 5}) {
    LocalNetwork network(3, 1, 0.0);
    network.mute_after(2, 1 + answers);  // it reports that it is ready
    accel::HitBuffer hits = place.no_hits();
    ProducerOptions options = impatient();
    options.in_flight = 2;
    options.batch = 2;
    const ClusterReport report = place.hits(network, 3, options, hits);
    EXPECT_TRUE(hits == expected) << answers;
    EXPECT_EQ(report.lost, std::vector<ProcessId>{2});
    ASSERT_EQ(report.remarks.size(), 2U);
    EXPECT_NE(report.remarks[0].find("process 2 was silent"), std::string::npos);
    EXPECT_NE(report.remarks[1].find("at the end"), std::string::npos);
  }
}

TEST(Cluster, FinishesAloneIfAllConsumersAreSilentOrMissing) {
  const scenes::Scene scene = verify::random_scene(6, 60);
  const Workplace place(scene, options_with(5), 1);
  const accel::HitBuffer expected = place.sequential_hits();
  for (const int messages : {0, 1, 3}) {
    LocalNetwork network(3, 1, 0.0);
    network.mute_after(1, messages);
    network.mute_after(2, messages);
    accel::HitBuffer hits = place.no_hits();
    place.hits(network, 3, impatient(), hits);
    EXPECT_TRUE(hits == expected) << messages;
  }
}

TEST(Cluster, EndsWithAnErrorIfAProcessDoesNotMatch) {
  const scenes::Scene scene = verify::random_scene(6, 20);
  const accel::beam::BeamTracer tracer(scene, options_with(4));
  const accel::PrimaryRays rays(scene.cameras.front(), 20, 20, 1);
  LocalNetwork network(3, 1, 0.0);
  std::vector<std::jthread> consumers;  // must be shut down, or the test would not end
  for (const ProcessId process : {1, 2}) {
    consumers.emplace_back([&, process] {
      ImageWorker worker(tracer, rays, nullptr);
      consume(network.at(process), worker, 1.0, {});
    });
  }
  BeamSource source(tracer, rays);
  accel::HitBuffer hits(20, 20, 1);
  HitSink sink(hits);
  ImageWorker own(tracer, rays, nullptr);
  const auto check = [](ProcessId process, std::span<const std::byte>) {
    if (process == 2) throw InputError("wrong");
  };
  EXPECT_THROW(Producer(network.at(0), source, sink, own, check, {}).run(), InputError);
}

TEST(Cluster, RunsFromACommandLineToItsEnd) {
  accel::HitBuffer expected(40, 30, 4);
  const scenes::Scene scene = scenes::load_scene("tetra:n=2");
  accel::beam::BeamTracer(scene, options_with(6))
      .closest_hits(accel::PrimaryRays(scene.cameras.front(), 40, 30, 4), expected, {});
  ClusterRequest request;
  request.job.scene = "tetra:n=2";
  request.job.structure = "beam:max_level=6";
  request.job.resolution = {40, 30};
  request.job.samples = 4;
  LocalNetwork network(3, 1, 0.0001);
  const ClusterRun run = led(lead, request, network);
  EXPECT_EQ(run.result_hash, rays::fingerprint(expected));
  EXPECT_EQ(run.ready_reports[2].identity, run.ready_reports[0].identity);
}

TEST(Cluster, FindsTheSequentialHitsForAnyDivisionOfTheImage) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=3");
  for (const char* structure :
       {"beam:max_level=5", "beam:max_level=5,share_corners=true,handover=40"}) {
    accel::HitBuffer expected(53, 41, 5);
    accel::beam::BeamTracer(scene, options_with(5))
        .closest_hits(accel::PrimaryRays(scene.cameras.front(), 53, 41, 5), expected, {});
    for (const Work work :
         {Work::kTiles, Work::kContiguous, Work::kInterlaced, Work::kWindows, Work::kPrePass}) {
      for (const int processes : {1, 2, 5}) {
        ClusterRequest request;
        request.job.scene = "tetra:n=3";
        request.job.structure = structure;
        request.job.resolution = {53, 41};
        request.job.samples = 5;
        request.work = work;
        request.block_size = 7;
        LocalNetwork network(processes, 1, 0.0001);
        const ClusterRun run = led(lead, request, network);
        EXPECT_EQ(run.result_hash, rays::fingerprint(expected))
            << structure << ' ' << name_of(work) << ' ' << processes;
        // A static division takes one message for each consumer, and one for the end.
        if (!is_static(work)) continue;
        const auto consumers = static_cast<std::uint64_t>(processes - 1);
        EXPECT_EQ(run.report.total(&ProcessReport::from_producer).messages, 2 * consumers);
      }
    }
  }
}

TEST(Cluster, ShutsAllDownIfTheSceneIsMissing) {
  ClusterRequest request;
  request.job.scene = "no-such-scene";
  request.job.structure = "beam";
  LocalNetwork network(2, 1, 0.001);
  EXPECT_THROW(led(lead, request, network), InputError);
}

}  // namespace
}  // namespace beambench::cluster
