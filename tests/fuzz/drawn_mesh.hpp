#pragma once
// Meshes drawn from the bytes of an input, their numbers as text, and the expected scene of each.
// This code neither calls a reader nor shares code with the readers.

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/vec3.hpp>

#include "scenes/formats/mesh/mesh.hpp"
#include "scenes/scene.hpp"
#include "scenes/scene_builder.hpp"
#include "scenes/triangulate.hpp"
#include "tests/fuzz/target.hpp"

namespace beambench::fuzz {

/// Draws numbers from the bytes of an input; after the last byte, draws them at random. All bytes
/// seed the random numbers, so that every input, however short, yields a different file.
class Draw {
 public:
  explicit Draw(std::string_view bytes) : bytes_(bytes), state_(0xcbf29ce484222325U) {
    for (const char byte : bytes) {  // FNV-1a
      state_ = (state_ ^ static_cast<unsigned char>(byte)) * 0x100000001b3U;
    }
  }

  std::uint32_t bits() {
    std::uint32_t result = 0;
    for (int i = 0; i < 4; ++i) result = result << 8U | byte();
    return result;
  }
  /// Returns a number less than `count`, which is at most 256.
  std::size_t below(std::size_t count) { return byte() % count; }
  bool once_in(std::size_t count) { return below(count) == 0; }
  template <typename List>
  const auto& of(const List& list) {
    return list[below(std::size(list))];
  }

 private:
  std::uint32_t byte() {
    if (!bytes_.empty()) {
      const auto first = static_cast<unsigned char>(bytes_.front());
      bytes_.remove_prefix(1);
      return first;
    }
    state_ += 0x9e3779b97f4a7c15U;  // splitmix64 (Steele, Lea and Flood 2014)
    std::uint64_t mixed = (state_ ^ (state_ >> 30U)) * 0xbf58476d1ce4e5b9U;
    mixed = (mixed ^ (mixed >> 27U)) * 0x94d049bb133111ebU;
    return static_cast<std::uint32_t>((mixed ^ (mixed >> 31U)) & 0xffU);
  }

  std::string_view bytes_;
  std::uint64_t state_;
};

/// A coordinate: the number in the file, its text, and the float that it must become.
struct DrawnNumber {
  double value = 0.0;
  std::string text;
  float expected = 0.0F;
};

/// Returns a number as text, with all of its digits (a double has at most 767).
inline std::string exact_text(double value) {
  int exponent = 0;
  const double mantissa = std::frexp(value, &exponent);
  const auto whole = static_cast<std::int64_t>(std::ldexp(mantissa, 53));
  // The number is a multiple of two to the power of `lowest`: it has that many decimal places.
  const int lowest =
      exponent - 53 + (whole == 0 ? 53 : std::countr_zero(static_cast<std::uint64_t>(whole)));
  constexpr int kBeforePoint = 10;
  const int precision = std::clamp(-lowest, 0, 767) + kBeforePoint;
  std::array<char, 800> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value,
                                          std::chars_format::scientific, precision);
  require(error == std::errc(), "a number has more digits than a double can have");
  const std::string_view all(text.data(), static_cast<std::size_t>(end - text.data()));
  const std::string_view digits = all.substr(0, all.find('e'));
  return fmt::format("{}{}", digits.substr(0, digits.find_last_not_of('0') + 1),
                     all.substr(digits.size()));
}

/// Returns a float from -1e9 to 1e9, often a small whole number.
inline float drawn_float(Draw& draw) {
  if (draw.once_in(2)) return static_cast<float>(draw.below(9)) - 4.0F;
  constexpr std::uint32_t kLimit = 0x4e6e6b28;  // 1e9
  const float size = std::bit_cast<float>(draw.bits() % kLimit);
  return draw.once_in(2) ? size : -size;
}

/// Returns a double near a float: the float itself, a double close to it, or the midpoint between
/// it and the next.
inline double drawn_double(Draw& draw) {
  const float base = drawn_float(draw);
  const double value = base;
  const float toward = std::abs(base) < 1e8F ? base + std::abs(base) : 0.0F;
  const double next = std::nextafterf(base, toward);
  switch (draw.below(4)) {
    case 0:
      return value;
    case 1:
      return 0.5 * (value + next);
    case 2:
      return value + (next - value) * (draw.bits() * 0x1p-32);
    default:
      return std::nextafter(0.5 * (value + next), draw.once_in(2) ? -1e300 : 1e300);
  }
}

/// Returns the float nearest to a number whose magnitude is slightly greater than that of `value`,
/// by far less than the distance between two doubles. If `value` is the midpoint between two
/// floats, that is the float with the greater magnitude.
inline float rounded_beyond(double value) {
  const auto nearest = static_cast<float>(value);
  const double rest = value - static_cast<double>(nearest);
  if (rest == 0.0 || std::signbit(rest) != std::signbit(value)) return nearest;
  const float farther = std::nextafterf(nearest, std::copysign(INFINITY, nearest));
  const bool is_middle = static_cast<double>(nearest) + static_cast<double>(farther) == 2.0 * value;
  return is_middle ? farther : nearest;
}

/// Returns a coordinate for a text file, which is read as a float.
inline DrawnNumber drawn_decimal(Draw& draw) {
  const double value = drawn_double(draw);
  const auto nearest = static_cast<float>(value);
  switch (draw.below(6)) {
    case 0:
      return {nearest, fmt::format("{}", nearest), nearest};
    case 1:
      return {nearest, fmt::format("{:.8e}", nearest), nearest};
    case 2:
      return {nearest, fmt::format("{:.17G}", nearest), nearest};
    case 3:
      return {value, exact_text(value), nearest};
    case 4: {
      std::string text = exact_text(value);
      if (value == 0.0) return {value, text, nearest};  // an excess beyond 0 has no sign
      text.insert(text.find('e'), "00000000000000000000000000000000000000001");
      return {value, text, rounded_beyond(value)};
    }
    default:
      return {nearest, fmt::format("{}{}", std::signbit(nearest) ? "" : "+", exact_text(nearest)),
              nearest};
  }
}

using Corners = std::array<glm::vec3, 3>;

/// Adds the expected triangles of a face.
inline void expect_face(std::vector<Corners>& triangles, const std::vector<glm::vec3>& vertices,
                        const std::vector<std::uint32_t>& face) {
  std::vector<glm::vec3> places;
  for (const std::uint32_t corner : face) places.push_back(vertices[corner] + 0.0F);
  if (face.size() < 3) return;
  for (const auto& [a, b, c] : scenes::triangulate(places)) {
    if (scenes::has_area(places[a], places[b], places[c])) {
      triangles.push_back({places[a], places[b], places[c]});
    }
  }
}

/// Returns faces of 0 to 5 corners of `vertices` vertices.
inline std::vector<std::vector<std::uint32_t>> drawn_faces(Draw& draw, std::size_t vertices) {
  std::vector<std::vector<std::uint32_t>> faces(draw.below(6));
  for (auto& face : faces) {
    face.resize(draw.once_in(3) ? draw.below(6) : 3);
    for (std::uint32_t& corner : face) corner = static_cast<std::uint32_t>(draw.below(vertices));
  }
  return faces;
}

/// Returns the hash of a scene of these triangles; nothing if there are none, or if it is too small
/// for a scene.
inline std::optional<std::uint64_t> hash_of(const std::vector<Corners>& triangles) {
  if (triangles.empty()) return std::nullopt;
  return accepted([&] {
    scenes::SceneBuilder builder("triangles");
    for (const Corners& corners : triangles) {
      const std::array<glm::dvec3, 3> places = {corners[0], corners[1], corners[2]};
      builder.add_polygon(places);
    }
    return scene_hash(std::move(builder).build());
  });
}

/// Throws std::logic_error, with the file, unless reading returns the scene of the expected
/// triangles or, if none are expected, refuses the file. `read` returns an imported mesh.
template <class Read>
void check_scene(const std::vector<Corners>& expected, std::string_view file, Read&& read) {
  const auto fail = [&](std::string_view how) {
    throw std::logic_error(fmt::format("{}, of the file:\n{}", how, file));
  };
  try {
    const scenes::mesh::TriangleMesh mesh = read().mesh;
    std::vector<Corners> triangles;
    for (const auto& [a, b, c] : mesh.triangles) {
      triangles.push_back({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
    }
    if (triangles.size() != expected.size()) fail("another number of triangles was read");
    if (hash_of(triangles) != hash_of(expected)) fail("another scene was read");
  } catch (const InputError& error) {
    const bool is_empty = std::string_view(error.what()).find(" no ") != std::string_view::npos;
    if (!expected.empty() || !is_empty) fail(error.what());
  }
}

}  // namespace beambench::fuzz
