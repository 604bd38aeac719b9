#include "harness/cluster/image_worker.hpp"

#include <algorithm>
#include <array>

#include "harness/cluster/sample_results.hpp"

namespace beambench::cluster {
namespace {

constexpr std::array kCounts{&render::RayCensus::eye,
                             &render::RayCensus::eye_hits,
                             &render::RayCensus::reflected,
                             &render::RayCensus::refracted,
                             &render::RayCensus::totally_reflected,
                             &render::RayCensus::secondary_hits,
                             &render::RayCensus::too_faint,
                             &render::RayCensus::shadow,
                             &render::RayCensus::shadow_hidden,
                             &render::RayCensus::shadow_cached,
                             &render::RayCensus::shadow_listed,
                             &render::RayCensus::shadow_tests,
                             &render::RayCensus::shadow_queries};
static_assert(sizeof(render::RayCensus) == kCounts.size() * sizeof(std::uint64_t),
              "a count is missing");

}  // namespace

ImageWorker::ImageWorker(const accel::beam::BeamTracer& tracer, const accel::PrimaryRays& rays,
                         const render::Whitted* light)
    : tracer_(&tracer),
      rays_(&rays),
      light_(light),
      view_(tracer.octree().grid(), rays),
      hits_(rays.width(), rays.height(), rays.samples()),
      painter_(tracer.scene(), tracer, tracer.options(), view_, rays, sight_, hits_, {}, decided_) {
}

void ImageWorker::perform(std::span<const std::byte> task, Bytes& result,
                          const Heartbeat& heartbeat) {
  decided_.begin(heartbeat);
  std::visit([this](const auto& each) { trace(each); }, read_task(task, tracer_->octree(), view_));
  // Beams find their samples lattice by lattice; sorted, a pixel's samples are neighbors.
  std::vector<std::uint32_t>& samples = decided_.samples();
  std::ranges::sort(samples);
  if (light_ == nullptr) {
    write_hits(samples, hits_, result);
    return;
  }
  // A new one for each task, so that the census does not depend on their distribution.
  render::Whitted::Progress progress = light_->begin();
  write_colors(samples, hits_, *rays_, *light_, progress, heartbeat, result);
  census_ += progress.census;
}

void ImageWorker::trace(const BeamTask& task) {
  switch (task.kind) {
    case BeamTask::Kind::kTestLeaf:
      painter_.test_leaf(task.beam);
      break;
    case BeamTask::Kind::kSmall:
      painter_.hand_over(task.beam, accel::beam::RayReason::kHandover);
      break;
    case BeamTask::Kind::kCrowded:
      painter_.hand_over(task.beam, accel::beam::RayReason::kCrowded);
      break;
  }
}

void ImageWorker::trace(const BlockTask& block) {
  if (block.left + block.width > rays_->width() || block.top + block.height > rays_->height()) {
    throw ProtocolError("a block outside of the image");
  }
  for (int y = block.top; y < block.top + block.height; ++y) {
    for (int x = block.left; x < block.left + block.width; ++x) {
      for (int sample = 0; sample < rays_->samples(); ++sample) {
        const std::size_t index = hits_.index(x, y, sample);
        hits_.set(index, tracer_->closest_hit(rays_->ray(x, y, sample), nullptr));
        decided_.painted(index);
      }
    }
  }
}

void ImageWorker::write_counts(Bytes& bytes) const {
  ByteWriter writer(bytes);
  for (const auto count : kCounts) writer.put(census_.*count);
}

render::RayCensus read_census(std::span<const std::byte> bytes) {
  ByteReader reader(bytes);
  render::RayCensus census;
  for (const auto count : kCounts) census.*count = reader.get<std::uint64_t>();
  return census;
}

}  // namespace beambench::cluster
