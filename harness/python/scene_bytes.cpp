#include "harness/python/scene_bytes.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <memory>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "harness/rays/fingerprint.hpp"
#include "scenes/base/error.hpp"

namespace beambench::python {
namespace {

// Incremented when the members of a scene change.
constexpr std::string_view kFirstLine = "beambench-scene 2\n";

static_assert(std::endian::native == std::endian::little,
              "numbers are kept exactly as stored in memory");

/// The members of each type, in order. A structured binding names all of them, so forgetting a new
/// member here is a compiler error.
template <class T>
auto members(T& object) {
  using Type = std::remove_const_t<T>;
  if constexpr (std::is_same_v<Type, scenes::Scene>) {
    auto& [name, cameras, background, lights, surfaces, primitives, spheres, cones, polygons,
           triangles, vertices, corners, normals, bounds, frame, first_frame] = object;
    return std::tie(name, cameras, background, lights, surfaces, primitives, spheres, cones,
                    polygons, triangles, vertices, corners, normals, bounds, frame, first_frame);
  } else if constexpr (std::is_same_v<Type, scenes::Camera>) {
    auto& [name, from, at, up, angle, aspect, hither, width, height] = object;
    return std::tie(name, from, at, up, angle, aspect, hither, width, height);
  } else if constexpr (std::is_same_v<Type, scenes::Surface>) {
    auto& [color, diffuse, specular, shine, transmittance, index, finish] = object;
    return std::tie(color, diffuse, specular, shine, transmittance, index, finish);
  } else if constexpr (std::is_same_v<Type, scenes::Light>) {
    auto& [position, color] = object;
    return std::tie(position, color);
  } else if constexpr (std::is_same_v<Type, scenes::Sphere>) {
    auto& [center, radius, inside_only] = object;
    return std::tie(center, radius, inside_only);
  } else if constexpr (std::is_same_v<Type, scenes::Cone>) {
    auto& [base, base_radius, apex, apex_radius, inside_only] = object;
    return std::tie(base, base_radius, apex, apex_radius, inside_only);
  } else {
    static_assert(std::is_same_v<Type, scenes::Bounds>);
    auto& [lower, upper] = object;
    return std::tie(lower, upper);
  }
}

/// Copies types that consist only of numbers, without padding, as they are; padding bytes would
/// make two pickles of one scene differ.
template <class T>
constexpr bool kIsPlain = std::is_arithmetic_v<T> || std::is_enum_v<T> ||
                          std::is_same_v<T, glm::vec3> ||
                          (std::is_trivially_copyable_v<T> &&
                           std::has_unique_object_representations_v<T>);

class Writer {
 public:
  template <class T>
  void add(const T& value) {
    if constexpr (kIsPlain<T>) {
      add_bytes(&value, sizeof value);
    } else {
      std::apply([this](const auto&... each) { (add(each), ...); }, members(value));
    }
  }
  void add(const std::string& text) { add_all(text); }
  void add(const std::shared_ptr<const scenes::Scene>& scene) {
    add(std::uint8_t{scene != nullptr});
    if (scene) add(*scene);
  }
  template <class T>
  void add(const std::vector<T>& values) {
    add_all(values);
  }

  std::string bytes{kFirstLine};

 private:
  template <class Values>
  void add_all(const Values& values) {
    add(std::uint64_t{values.size()});
    if constexpr (kIsPlain<typename Values::value_type>) {
      add_bytes(values.data(), values.size() * sizeof(typename Values::value_type));
    } else {
      for (const auto& each : values) add(each);
    }
  }

  void add_bytes(const void* data, std::size_t size) {
    bytes.append(static_cast<const char*>(data), size);
  }
};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {}

  template <class T>
  void take(T& value) {
    if constexpr (kIsPlain<T>) {
      take_bytes(&value, sizeof value);
    } else {
      std::apply([this](auto&... each) { (take(each), ...); }, members(value));
    }
  }
  void take(std::string& text) { take_all(text); }
  void take(std::shared_ptr<const scenes::Scene>& scene) {
    std::uint8_t is_there = 0;
    take(is_there);
    if (is_there == 0) return;
    auto read = std::make_shared<scenes::Scene>();
    take(*read);
    scene = std::move(read);
  }
  template <class T>
  void take(std::vector<T>& values) {
    take_all(values);
  }

 private:
  template <class Values>
  void take_all(Values& values) {
    std::uint64_t count = 0;
    take(count);
    values.resize(count);
    if constexpr (kIsPlain<typename Values::value_type>) {
      take_bytes(values.data(), count * sizeof(typename Values::value_type));
    } else {
      for (auto& each : values) take(each);
    }
  }

  void take_bytes(void* data, std::size_t size) {
    if (size > 0) std::memcpy(data, rest_.data(), size);
    rest_.remove_prefix(size);
  }

  std::string_view rest_;
};

}  // namespace

std::string bytes_of_scene(const scenes::Scene& scene) {
  Writer writer;
  writer.add(scene);
  writer.add(rays::fingerprint(writer.bytes));
  return std::move(writer.bytes);
}

scenes::Scene scene_of_bytes(std::string_view bytes) {
  if (!bytes.starts_with(kFirstLine)) {
    throw InputError(
        fmt::format("the scene was pickled by another version of beambench; expected '{}' at the "
                    "start; pickle it again with this version",
                    kFirstLine.substr(0, kFirstLine.size() - 1)));
  }
  std::uint64_t hash = 0;
  const std::size_t end = bytes.size() - std::min(sizeof hash, bytes.size());
  std::memcpy(&hash, bytes.data() + end, bytes.size() - end);
  if (end < kFirstLine.size() || hash != rays::fingerprint(bytes.substr(0, end))) {
    throw InputError("the pickled scene is damaged: its hash differs from that of its bytes");
  }
  scenes::Scene scene;
  Reader(bytes.substr(kFirstLine.size(), end - kFirstLine.size())).take(scene);
  return scene;
}

}  // namespace beambench::python
