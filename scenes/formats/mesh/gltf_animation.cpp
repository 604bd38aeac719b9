#include "scenes/formats/mesh/gltf_animation.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "scenes/base/portable_math.hpp"
#include "scenes/formats/mesh/gltf_accessors.hpp"
#include "scenes/formats/mesh/gltf_file.hpp"

namespace beambench::scenes::mesh {
namespace {

using Value = std::array<double, 4>;

/// Returns the weighted sum of two values.
Value sum(double a_factor, const Value& a, double b_factor, const Value& b) {
  Value result{};
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = a_factor * a[i] + b_factor * b[i];
  return result;
}

double dot(const Value& a, const Value& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

Value normalized(const Value& value) {
  const double length = std::sqrt(dot(value, value));
  return length > 0.0 ? sum(1.0 / length, value, 0.0, value) : Value{0.0, 0.0, 0.0, 1.0};
}

/// Returns the angle in [0, pi / 4] with this sine, by Newton's method: the library's arcsine may
/// differ in its last bits between machines.
double portable_small_arcsine(double sine) {
  double angle = sine;
  for (int i = 0; i < 6; ++i) angle -= (portable_sin(angle) - sine) / portable_cos(angle);
  return angle;
}

/// Interpolates between two rotations along the shorter arc.
Value slerp(const Value& from, const Value& to, double share) {
  const Value a = normalized(from);
  Value b = normalized(to);
  if (dot(a, b) < 0.0) b = sum(-1.0, b, 0.0, b);
  const Value chord = sum(1.0, b, -1.0, a);
  const double angle = 2.0 * portable_small_arcsine(0.5 * std::sqrt(dot(chord, chord)));
  const double sine = portable_sin(angle);
  if (sine < 1e-9) return normalized(sum(1.0 - share, a, share, b));
  return normalized(
      sum(portable_sin((1.0 - share) * angle) / sine, a, portable_sin(share * angle) / sine, b));
}

/// Evaluates a Hermite spline over an interval of that length (glTF 2.0, appendix C).
Value cubic(const Value* from, const Value* to, double share, double length) {
  const double s = share;
  const double s2 = s * s;
  const double s3 = s2 * s;
  const Value places = sum(2.0 * s3 - 3.0 * s2 + 1.0, from[1], 3.0 * s2 - 2.0 * s3, to[1]);
  const Value tangents = sum(length * (s3 - 2.0 * s2 + s), from[2], length * (s3 - s2), to[0]);
  return sum(1.0, places, 1.0, tangents);
}

std::vector<double> times_of(const tinygltf::Model& model, int accessor, const std::string& user) {
  const GltfNumbers numbers(model, accessor, TINYGLTF_TYPE_SCALAR, user);
  std::vector<double> times;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const double time = numbers.at(i, 0);
    if (!std::isfinite(time) || time < 0.0 || (i > 0 && time <= times.back())) {
      refuse_gltf(fmt::format("{}: time {} is {}; times must be numbers from 0 that increase", user,
                              i, time));
    }
    times.push_back(time);
  }
  return times;
}

std::vector<Value> values_of(const tinygltf::Model& model, int accessor, bool is_rotation,
                             std::size_t expected, const std::string& user) {
  const GltfNumbers numbers(model, accessor, is_rotation ? TINYGLTF_TYPE_VEC4 : TINYGLTF_TYPE_VEC3,
                            user);
  if (numbers.size() != expected) {
    refuse_gltf(
        fmt::format("{}: {} values, but its times need {}", user, numbers.size(), expected));
  }
  std::vector<Value> values(expected);
  for (std::size_t i = 0; i < expected; ++i) {
    for (std::size_t j = 0; j < (is_rotation ? 4U : 3U); ++j) {
      values[i][j] = numbers.at(i, j);
      if (std::isfinite(values[i][j])) continue;
      refuse_gltf(fmt::format("{}: value {} is not finite", user, i));
    }
  }
  return values;
}

}  // namespace

GltfAnimation::GltfAnimation(const tinygltf::Model& model, int number) {
  const tinygltf::Animation& animation =
      element_of(model.animations, number, "animation", "the file");
  for (std::size_t i = 0; i < animation.channels.size(); ++i) {
    const tinygltf::AnimationChannel& given = animation.channels[i];
    const std::string user = fmt::format("channel {} of animation {}", i, number);
    Channel channel{};
    if (given.target_path == "translation") {
      channel.path = Path::kTranslation;
    } else if (given.target_path == "rotation") {
      channel.path = Path::kRotation;
    } else if (given.target_path == "scale") {
      channel.path = Path::kScale;
    } else {
      ++others_;
      continue;
    }
    if (given.target_node < 0) continue;  // glTF 2.0, 3.11: such a channel is to be ignored
    channel.node = given.target_node;
    const tinygltf::Node& node = element_of(model.nodes, channel.node, "node", user);
    if (!node.matrix.empty()) {
      refuse_gltf(fmt::format("{} is for node {}, which has a matrix", user, channel.node));
    }
    if (!targets_.emplace(channel.node, channel.path).second) {
      refuse_gltf(fmt::format("{} is for the {} of node {}, as is an earlier channel", user,
                              given.target_path, channel.node));
    }
    const tinygltf::AnimationSampler& sampler =
        element_of(animation.samplers, given.sampler, "sampler", user);
    const std::string source = fmt::format("sampler {} of animation {}", given.sampler, number);
    if (sampler.interpolation == "STEP") {
      channel.interpolation = Interpolation::kStep;
    } else if (sampler.interpolation == "CUBICSPLINE") {
      channel.interpolation = Interpolation::kCubic;
    } else if (sampler.interpolation == "LINEAR" || sampler.interpolation.empty()) {
      channel.interpolation = Interpolation::kLinear;
    } else {
      refuse_gltf(fmt::format("{} has an unknown interpolation", source));
    }
    channel.times = times_of(model, sampler.input, source);
    const std::size_t each = channel.interpolation == Interpolation::kCubic ? 3 : 1;
    channel.values = values_of(model, sampler.output, channel.path == Path::kRotation,
                               each * channel.times.size(), source);
    duration_ = std::max(duration_, channel.times.back());
    channels_.push_back(std::move(channel));
  }
}

GltfAnimation::Value GltfAnimation::value_at(const Channel& channel, double time) {
  const bool is_cubic = channel.interpolation == Interpolation::kCubic;
  const std::size_t each = is_cubic ? 3 : 1;
  const auto key = [&](std::size_t index) { return &channel.values[each * index]; };
  const auto value = [&](std::size_t index) { return key(index)[is_cubic ? 1 : 0]; };
  const auto next = std::ranges::upper_bound(channel.times, time);
  if (next == channel.times.begin()) return value(0);
  const auto at = static_cast<std::size_t>(std::distance(channel.times.begin(), next)) - 1;
  if (next == channel.times.end() || channel.interpolation == Interpolation::kStep) {
    return value(at);
  }
  const double length = *next - channel.times[at];
  const double share = (time - channel.times[at]) / length;
  if (is_cubic) return cubic(key(at), key(at + 1), share, length);
  if (channel.path == Path::kRotation) return slerp(value(at), value(at + 1), share);
  return sum(1.0 - share, value(at), share, value(at + 1));
}

void GltfAnimation::pose(std::vector<tinygltf::Node>& nodes, double time) const {
  for (const Channel& channel : channels_) {
    tinygltf::Node& node = nodes[static_cast<std::size_t>(channel.node)];
    const Value value = value_at(channel, time);
    switch (channel.path) {
      case Path::kTranslation:
        node.translation.assign(value.begin(), value.begin() + 3);
        break;
      case Path::kRotation: {
        const Value rotation = normalized(value);
        node.rotation.assign(rotation.begin(), rotation.end());
        break;
      }
      case Path::kScale:
        node.scale.assign(value.begin(), value.begin() + 3);
        break;
    }
  }
}

}  // namespace beambench::scenes::mesh
