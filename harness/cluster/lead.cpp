#include "harness/cluster/lead.hpp"

#include <memory>
#include <optional>
#include <string_view>

#include "harness/cluster/consumer.hpp"
#include "harness/cluster/image_worker.hpp"
#include "harness/cluster/sample_results.hpp"
#include "harness/cluster/set_up.hpp"
#include "harness/cluster/split/split_run.hpp"
#include "harness/cluster/studio.hpp"
#include "harness/cluster/task_sources.hpp"
#include "harness/rays/fingerprint.hpp"
#include "harness/rays/hit_check.hpp"
#include "harness/render/picture/image_file.hpp"
#include "harness/render/shading.hpp"
#include "scenes/core/error.hpp"
#include "scenes/core/files.hpp"

namespace beambench::cluster {
namespace {

std::unique_ptr<TaskSource> make_source(const ClusterRequest& request, const Studio& studio) {
  const accel::PrimaryRays& rays = studio.rays();
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
    const accel::PrimaryRays& rays = studio.rays();
    color_sink_.emplace(rays.width(), rays.height(), rays.samples(),
                        glm::dvec3(render::background_color(studio.scene())));
  }

  ResultSink& sink() {
    if (color_sink_) return *color_sink_;
    return hit_sink_;
  }

  render::Image picture(const Studio& studio, render::Shading shading) const {
    if (color_sink_) return color_sink_->image();
    rays::HitCheck(studio.scene(), "structure 'beam'").require(hits_, studio.rays());
    return render::shade(studio.scene(), studio.rays(), hits_, shading);
  }

  std::uint64_t hash() const {
    if (!color_sink_) return rays::fingerprint(hits_);
    const render::Image image = color_sink_->image();
    const std::size_t pixels =
        static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height());
    return rays::fingerprint(std::string_view(reinterpret_cast<const char*>(&image.at(0, 0)),
                                              pixels * sizeof(glm::vec3)));
  }

 private:
  accel::HitBuffer hits_;
  HitSink hit_sink_;
  std::optional<ColorSink> color_sink_;
};

void write_files(const ClusterRequest& request, const Studio& studio, const Result& result,
                 const ClusterRun& run) {
  if (!request.picture.empty()) {
    render::write_image(request.picture, result.picture(studio, request.shading));
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

}  // namespace

ClusterRun lead(const ClusterRequest& request, Transport& transport) {
  std::optional<Studio> studio;
  std::unique_ptr<TaskSource> source;
  set_up_to_lead(transport, [&](std::vector<std::string>& warnings) {
    studio.emplace(request.job, &warnings);
    source = make_source(request, *studio);
  });
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
  const auto job = set_up_to_follow(transport, [&] { return read_job(bytes); });
  if (!job) return;
  if (job->split_level > 0) return follow_split(*job, transport);
  const auto studio = set_up_to_follow(transport, [&] { return std::make_unique<Studio>(*job); });
  if (!studio) return;
  const Studio& built = **studio;
  ImageWorker worker(built.tracer(), built.rays(), built.light());
  Consumer(transport, worker, job->alive_every).run(write_introduction(built.introduction()));
}

}  // namespace beambench::cluster
