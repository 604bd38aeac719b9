#include "harness/cluster/sample_results.hpp"

#include <cstring>

namespace beambench::cluster {
namespace {

/// The contents of a run of results of `write_colors`.
enum class Part : std::uint8_t { kPixels, kSample };

/// The number of samples that follow each other without a gap.
std::size_t run_length(SampleList samples) {
  std::size_t length = 1;
  while (length < samples.size() && samples[length] == samples[0] + length) ++length;
  return length;
}

/// The mean of a pixel's samples, in the order and the precision of `whitted_picture`.
template <class Color>
glm::vec3 mean(int samples, Color color) {
  glm::dvec3 sum(0.0);
  for (int sample = 0; sample < samples; ++sample) sum += color(sample);
  const glm::vec3 result((1.0 / samples) * sum);
  return result;
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

/// Light along the samples of an image.
class SampleColors {
 public:
  SampleColors(const accel::HitBuffer& hits, const accel::PrimaryRays& rays,
               const render::Whitted& tracer, render::Whitted::Progress& progress)
      : hits_(&hits), rays_(&rays), tracer_(&tracer), progress_(&progress) {}

  glm::dvec3 at(std::uint32_t index) const {
    const auto samples = static_cast<std::uint32_t>(hits_->samples());
    const auto width = static_cast<std::uint32_t>(hits_->width());
    const std::uint32_t pixel = index / samples;
    const accel::Ray ray =
        rays_->ray(static_cast<int>(pixel % width), static_cast<int>(pixel / width),
                   static_cast<int>(index % samples));
    return tracer_->camera_ray_color(ray, hits_->get(index), *progress_);
  }

 private:
  const accel::HitBuffer* hits_;
  const accel::PrimaryRays* rays_;
  const render::Whitted* tracer_;
  render::Whitted::Progress* progress_;
};

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
  const SampleColors colors(hits, rays, tracer, progress);
  const auto each = static_cast<std::uint32_t>(hits.samples());
  ByteWriter writer(bytes);
  while (!samples.empty()) {
    const std::uint32_t first = samples[0];
    const std::size_t pixels = first % each == 0 ? run_length(samples) / each : 0;
    if (pixels == 0) {
      writer.put(static_cast<std::uint8_t>(Part::kSample));
      writer.put(first);
      put_vector(colors.at(first), writer);
      samples = samples.subspan(1);
      heartbeat();
      continue;
    }
    writer.put(static_cast<std::uint8_t>(Part::kPixels));
    writer.put(first / each);
    writer.put(static_cast<std::uint32_t>(pixels));
    for (std::size_t i = 0; i < pixels; ++i) {
      const std::uint32_t sample = samples[i * each];
      put_vector(mean(hits.samples(),
                      [&](int k) { return colors.at(sample + static_cast<std::uint32_t>(k)); }),
                 writer);
      heartbeat();
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
    switch (static_cast<Part>(reader.get<std::uint8_t>())) {
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
  const auto width = static_cast<std::size_t>(image_.width());
  if (first + length > width * static_cast<std::size_t>(image_.height())) {
    throw ProtocolError("light of pixels outside of the image");
  }
  for (std::size_t pixel = first; pixel < first + length; ++pixel) {
    image_.at(static_cast<int>(pixel % width), static_cast<int>(pixel / width)) =
        get_vector<glm::vec3>(reader);
  }
  return length * static_cast<std::size_t>(samples_);
}

std::size_t ColorSink::accept_sample(ByteReader& reader) {
  const auto index = reader.get<std::uint32_t>();
  const auto each = static_cast<std::uint32_t>(samples_);
  const auto pixels =
      static_cast<std::size_t>(image_.width()) * static_cast<std::size_t>(image_.height());
  if (index / each >= pixels) throw ProtocolError("light of samples outside of the image");
  auto& samples = divided_[index / each];
  if (samples.empty()) samples.assign(each, background_);
  samples[index % each] = get_vector<glm::dvec3>(reader);
  return 1;
}

render::Image ColorSink::image() const {
  render::Image image = image_;
  for (const auto& divided : divided_) {
    const int x = static_cast<int>(divided.first) % image.width();
    const int y = static_cast<int>(divided.first) / image.width();
    image.at(x, y) = mean(
        samples_, [&](int sample) { return divided.second[static_cast<std::size_t>(sample)]; });
  }
  return image;
}

}  // namespace beambench::cluster
