#include "harness/thesis/cluster/image_worker.hpp"

#include <algorithm>
#include <optional>
#include <variant>

#include "accel/beam/beam_paths.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/thesis/cluster/image_division.hpp"

namespace beambench::cluster {
namespace {

/// The contents of a run in the results of `write_colors`.
enum class Part : std::uint8_t { kPixels, kSample };

/// Returns the number of samples up to the first gap.
std::size_t run_length(SampleList samples) {
  std::size_t length = 1;
  while (length < samples.size() && samples[length] == samples[0] + length) ++length;
  return length;
}

/// Returns the mean of a pixel's samples, in the order and precision of `whitted_picture`.
template <class Color>
glm::vec3 mean(int samples, Color color) {
  glm::dvec3 sum(0.0);
  for (int sample = 0; sample < samples; ++sample) sum += color(sample);
  return {(1.0 / samples) * sum};
}

/// Returns the light of samples, in order.
std::vector<glm::dvec3> colors_of(SampleList samples, const accel::HitBuffer& hits,
                                  const accel::PrimaryRays& rays, const render::Whitted& tracer,
                                  render::Whitted::Progress& progress, const Heartbeat& heartbeat) {
  constexpr std::size_t kBetweenHeartbeats = 1024;
  std::vector<glm::dvec3> colors(samples.size());
  for (std::size_t first = 0; first < samples.size(); first += kBetweenHeartbeats) {
    std::vector<accel::Ray> some;
    std::vector<std::optional<accel::Hit>> found;
    const std::size_t count = std::min(kBetweenHeartbeats, samples.size() - first);
    for (const std::uint32_t index : samples.subspan(first, count)) {
      some.push_back(rays::ray_at(rays, index));
      found.push_back(hits.get(index));
    }
    tracer.trace_light({&rays, some, samples.subspan(first, count), found},
                       std::span(colors).subspan(first, count), progress);
    heartbeat();
  }
  return colors;
}

template <class Vector>
void put_vector(const Vector& vector, ByteWriter& writer) {
  for (int i = 0; i < 3; ++i) writer.put(vector[i]);
}

template <class Vector>
Vector get_vector(ByteReader& reader) {
  Vector vector;
  for (int i = 0; i < 3; ++i) vector[i] = reader.get<typename Vector::value_type>();
  return vector;
}

/// Returns the outline of a part, with the same margin as `EyeView::screen`.
accel::beam::ImagePolygon outline_of(const accel::beam::PixelRect& part,
                                     const accel::PrimaryRays& rays,
                                     const accel::beam::EyeView& view) {
  const glm::dvec2 border = -view.screen()[0];
  const glm::dvec2 image(rays.width(), rays.height());
  const glm::dvec2 low = glm::dvec2(part.left, part.top) / image - border;
  const glm::dvec2 high =
      glm::dvec2(part.left + part.width, part.top + part.height) / image + border;
  accel::beam::ImagePolygon outline;
  outline.push_back(low);
  outline.push_back({high.x, low.y});
  outline.push_back(high);
  outline.push_back({low.x, high.y});
  return outline;
}

}  // namespace

void write_hits(SampleList samples, const accel::HitBuffer& hits, Bytes& bytes) {
  ByteWriter writer(bytes);
  while (!samples.empty()) {
    const std::size_t length = run_length(samples);
    writer.put(samples[0]);
    writer.put(static_cast<std::uint32_t>(length));
    for (const std::uint32_t index : samples.first(length)) {
      writer.put(hits.t()[index]);
      writer.put(hits.primitive()[index]);
    }
    samples = samples.subspan(length);
  }
}

std::size_t HitSink::accept(std::span<const std::byte> result) {
  ByteReader reader(result);
  std::size_t count = 0;
  while (!reader.at_end()) {
    const std::size_t first = reader.get<std::uint32_t>();
    const std::size_t length = reader.get<std::uint32_t>();
    if (first + length > hits_->size()) throw ProtocolError("hits of samples outside of the image");
    for (std::size_t index = first; index < first + length; ++index) {
      hits_->t()[index] = reader.get<float>();
      hits_->primitive()[index] = reader.get<scenes::PrimitiveId>();
    }
    count += length;
  }
  return count;
}

void write_colors(SampleList samples, const accel::HitBuffer& hits, const accel::PrimaryRays& rays,
                  const render::Whitted& tracer, render::Whitted::Progress& progress,
                  const Heartbeat& heartbeat, Bytes& bytes) {
  const std::vector<glm::dvec3> colors =
      colors_of(samples, hits, rays, tracer, progress, heartbeat);
  const auto each = static_cast<std::uint32_t>(hits.samples());
  auto color = colors.begin();
  ByteWriter writer(bytes);
  while (!samples.empty()) {
    const std::uint32_t first = samples[0];
    const std::size_t pixels = first % each == 0 ? run_length(samples) / each : 0;
    if (pixels == 0) {
      writer.put(Part::kSample);
      writer.put(first);
      put_vector(*color++, writer);
      samples = samples.subspan(1);
      continue;
    }
    writer.put(Part::kPixels);
    writer.put(first / each);
    writer.put(static_cast<std::uint32_t>(pixels));
    for (std::size_t i = 0; i < pixels; ++i) {
      put_vector(mean(hits.samples(), [&](int) { return *color++; }), writer);
    }
    samples = samples.subspan(pixels * each);
  }
}

ColorSink::ColorSink(int width, int height, int samples, const glm::dvec3& background)
    : samples_(samples),
      background_(background),
      image_(width, height, mean(samples, [&](int) { return background; })) {}

std::size_t ColorSink::accept(std::span<const std::byte> result) {
  ByteReader reader(result);
  std::size_t count = 0;
  while (!reader.at_end()) {
    switch (reader.get<Part>()) {
      case Part::kPixels:
        count += accept_pixels(reader);
        break;
      case Part::kSample:
        count += accept_sample(reader);
        break;
      default:
        throw ProtocolError("light of an unknown kind");
    }
  }
  return count;
}

std::size_t ColorSink::accept_pixels(ByteReader& reader) {
  const std::size_t first = reader.get<std::uint32_t>();
  const std::size_t length = reader.get<std::uint32_t>();
  if (first + length > image_.pixels().size()) {
    throw ProtocolError("light of pixels outside of the image");
  }
  for (glm::vec3& pixel : image_.pixels().subspan(first, length)) {
    pixel = get_vector<glm::vec3>(reader);
  }
  return length * static_cast<std::size_t>(samples_);
}

std::size_t ColorSink::accept_sample(ByteReader& reader) {
  const auto index = reader.get<std::uint32_t>();
  const auto each = static_cast<std::uint32_t>(samples_);
  if (index / each >= image_.pixels().size())
    throw ProtocolError("light of samples outside of the image");
  auto& samples = divided_[index / each];
  if (samples.empty()) samples.assign(each, background_);
  samples[index % each] = get_vector<glm::dvec3>(reader);
  return 1;
}

render::Image ColorSink::image() const {
  render::Image image = image_;
  for (const auto& divided : divided_) {
    image.pixels()[divided.first] = mean(
        samples_, [&](int sample) { return divided.second[static_cast<std::size_t>(sample)]; });
  }
  return image;
}

ImageWorker::ImageWorker(const accel::beam::BeamTracer& tracer, const accel::PrimaryRays& rays,
                         const render::Whitted* light)
    : tracer_(&tracer),
      rays_(&rays),
      light_(light),
      view_(tracer.octree().grid(), rays),
      lattices_(sight_.lattices(rays, tracer.options().share_corners)),
      hits_(rays.width(), rays.height(), rays.samples()),
      painter_(tracer.scene(), tracer, tracer.options(), view_, rays, sight_, hits_, {}, decided_) {
}

void ImageWorker::perform(std::span<const std::byte> task, Bytes& result,
                          const Heartbeat& heartbeat) {
  std::visit(
      [&](const auto& each) {
        perform(each, {&result, &heartbeat});
      },
      read_task(task, tracer_->octree(), view_));
}

void ImageWorker::write(const Results& results) {
  // Beams find their samples lattice by lattice; sorting makes a pixel's samples adjacent.
  std::vector<std::uint32_t>& samples = decided_.samples();
  std::ranges::sort(samples);
  samples_ += samples.size();
  if (light_ == nullptr) {
    write_hits(samples, hits_, *results.bytes);
    return;
  }
  // Begins anew each time, so that the census does not depend on the distribution of tasks.
  render::Whitted::Progress progress = light_->begin();
  write_colors(samples, hits_, *rays_, *light_, progress, *results.heartbeat, *results.bytes);
  census_ += progress.census;
}

void ImageWorker::perform(const BeamTask& task, const Results& results) {
  decided_.begin(*results.heartbeat);
  paint(task.kind, task.beam, painter_);
  write(results);
}

void ImageWorker::perform(const TileTask& tiles, const Results& results) {
  if (tiles.size == 0) throw ProtocolError("tiles without pixels");
  const TileOrder order(rays_->width(), rays_->height(), tiles.size);
  if (tiles.first + std::size_t{tiles.count} > order.count()) {
    throw ProtocolError("a tile outside of the image");
  }
  for (std::uint32_t i = 0; i < tiles.count; ++i) {
    decided_.begin(*results.heartbeat);
    trace_beams_through(order[tiles.first + i]);
    write(results);
    (*results.heartbeat)();
  }
}

void ImageWorker::trace_beams_through(const accel::beam::PixelRect& tile) {
  decided_.want(accel::beam::part_of(lattices_, hits_, tile));
  accel::beam::begin_beams(tracer_->octree(), view_, outline_of(tile, *rays_, view_), queue_);
  accel::beam::BeamStep step;
  while (!queue_.waiting.empty()) {
    queue_.waiting.pop(step);
    if (const auto end = end_of(step, *tracer_, *rays_)) {
      paint(*end, step.beam, painter_);
    } else if (step.kind != accel::BeamKind::kLeaving) {
      accel::beam::continue_beam(tracer_->octree(), view_, step.beam, queue_);
    }
  }
  decided_.want({});
}

void ImageWorker::perform(const BlockTask& block, const Results& results) {
  if (block.left + block.width > rays_->width() || block.top + block.height > rays_->height()) {
    throw ProtocolError("a block outside of the image");
  }
  decided_.begin(*results.heartbeat);
  for (int y = block.top; y < block.top + block.height; ++y) {
    for (int x = block.left; x < block.left + block.width; ++x) {
      for (int sample = 0; sample < rays_->samples(); ++sample) {
        const std::size_t index = hits_.index(x, y, sample);
        hits_.set(index, tracer_->closest_hit(rays_->ray(x, y, sample), nullptr));
        decided_.painted(index);
      }
    }
  }
  write(results);
}

void ImageWorker::write_counts(Bytes& bytes) const {
  ByteWriter writer(bytes);
  for (const render::CensusCount& each : render::kCensusCounts) writer.put(census_.*each.count);
}

render::RayCensus read_census(std::span<const std::byte> bytes) {
  ByteReader reader(bytes);
  render::RayCensus census;
  for (const render::CensusCount& each : render::kCensusCounts) {
    census.*each.count = reader.get<std::uint64_t>();
  }
  return census;
}

}  // namespace beambench::cluster
