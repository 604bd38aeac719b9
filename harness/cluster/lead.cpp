#include "harness/cluster/lead.hpp"

#include <cstdio>
#include <memory>
#include <new>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "harness/cluster/consumer.hpp"
#include "harness/cluster/image_worker.hpp"
#include "harness/cluster/sample_results.hpp"
#include "harness/cluster/split/split_run.hpp"
#include "harness/cluster/studio.hpp"
#include "harness/cluster/task_sources.hpp"
#include "harness/files/pending_file.hpp"
#include "harness/picture/image_file.hpp"
#include "harness/rays/fingerprint.hpp"
#include "harness/shade/preview.hpp"
#include "scenes/error.hpp"

namespace beambench {
namespace {

std::unique_ptr<TaskSource> make_source(const ClusterRequest& request, const Studio& studio) {
  const PrimaryRays& rays = studio.rays();
  if (request.blocks) {
    return std::make_unique<BlockSource>(rays.width(), rays.height(), request.block_size);
  }
  return std::make_unique<BeamSource>(studio.tracer(), rays);
}

/// Where results go and what comes of them.
class Result {
 public:
  Result(const Studio& studio, bool light)
      : hits_(light ? 1 : studio.rays().width(), light ? 1 : studio.rays().height(),
              light ? 1 : studio.rays().samples()),
        hit_sink_(hits_) {
    if (!light) return;
    const PrimaryRays& rays = studio.rays();
    color_sink_.emplace(rays.width(), rays.height(), rays.samples(),
                        glm::dvec3(background_color(studio.scene())));
  }

  ResultSink& sink() {
    if (color_sink_) return *color_sink_;
    return hit_sink_;
  }

  Image picture(const Studio& studio, Shading shading) const {
    if (color_sink_) return color_sink_->image();
    return shade(studio.scene(), studio.rays(), hits_, shading);
  }

  std::uint64_t hash() const {
    if (!color_sink_) return fingerprint(hits_);
    const Image image = color_sink_->image();
    const std::size_t pixels =
        static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height());
    return fingerprint(std::string_view(reinterpret_cast<const char*>(&image.at(0, 0)),
                                        pixels * sizeof(glm::vec3)));
  }

 private:
  HitBuffer hits_;
  HitSink hit_sink_;
  std::optional<ColorSink> color_sink_;
};

void write_files(const ClusterRequest& request, const Studio& studio, const Result& result,
                 const ClusterRun& run) {
  if (!request.picture.empty()) {
    write_image(request.picture, result.picture(studio, request.shading));
  }
  if (!request.report.empty()) write_file(request.report, to_json(run).dump(2) + "\n");
  if (!request.tasks.empty()) write_file(request.tasks, task_table(run.report));
}

/// All but the report.
ClusterRun describe(const ClusterRequest& request, const Studio& studio, int processes) {
  ClusterRun run;
  run.job = request.job;
  run.job.width = studio.rays().width();
  run.job.height = studio.rays().height();
  run.work = request.blocks ? "blocks" : "beams";
  run.batch = request.producer.batch;
  run.in_flight = request.producer.in_flight;
  run.producer_consumes = request.producer.consumes;
  run.introductions.resize(static_cast<std::size_t>(processes));
  run.introductions[kProducer] = studio.introduction();
  return run;
}

/// Why this process cannot work is told instead of how it is.
Introduction excuse(std::string problem) {
  Introduction introduction;
  introduction.host = host_name();
  introduction.problem = std::move(problem);
  return introduction;
}

}  // namespace

void send_all_home(Transport& transport) {
  for (ProcessId process = kProducer + 1; process < transport.processes(); ++process) {
    transport.send(process, Tag::kEnd, {});
  }
  transport.flush();
}

void wait_for_end(Transport& transport) {
  while (true) {
    const auto message = transport.wait(Transport::kForever);
    if (message && message->tag == Tag::kEnd) return;
  }
}

ClusterRun lead(const ClusterRequest& request, Transport& transport) {
  std::optional<Studio> studio;
  std::unique_ptr<TaskSource> source;
  try {
    std::vector<std::string> warnings;
    studio.emplace(request.job, &warnings);
    for (const std::string& warning : warnings) {
      fmt::print(stderr, "beambench-cluster: {}\n", warning);
    }
    source = make_source(request, *studio);
  } catch (...) {
    send_all_home(transport);
    throw;
  }
  ClusterRun run = describe(request, *studio, transport.processes());
  const auto check = [&, mine = studio->identity()](ProcessId process,
                                                    std::span<const std::byte> introduction) {
    run.introductions[static_cast<std::size_t>(process)] =
        read_introduction(process, introduction, mine);
  };
  Result result(*studio, request.job.light);
  ImageWorker own(studio->tracer(), studio->rays(), studio->light());
  run.report = Producer(transport, *source, result.sink(), own, check, request.producer).run();
  run.result_hash = result.hash();
  write_files(request, *studio, result, run);
  return run;
}

void follow(Transport& transport) {
  Bytes bytes;
  transport.broadcast(bytes);
  if (bytes.empty()) return;
  std::optional<Studio> studio;
  Job job;
  Introduction introduction;
  try {
    job = read_job(bytes);
    if (job.split_level > 0) return follow_split(job, transport);
    studio.emplace(job);
    introduction = studio->introduction();
  } catch (const InputError& error) {
    introduction = excuse(error.what());
  } catch (const std::bad_alloc&) {
    introduction = excuse("the memory does not suffice for this scene");
  }
  if (!introduction.problem.empty()) {
    transport.send(kProducer, Tag::kReady, write_introduction(introduction));
    wait_for_end(transport);
    return;
  }
  ImageWorker worker(studio->tracer(), studio->rays(), studio->light());
  Consumer(transport, worker, job.alive_every).run(write_introduction(introduction));
}

}  // namespace beambench
