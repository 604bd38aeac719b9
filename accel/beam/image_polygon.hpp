#pragma once
// A beam's cross-section: a convex polygon on the image plane, cut by lines.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <glm/vec2.hpp>

namespace beambench::accel::beam {

/// A vector of at most `Capacity` values. The caller checks `full()` before pushing.
template <class T, std::size_t Capacity>
class FixedVector {
 public:
  FixedVector() = default;
  ~FixedVector() = default;
  FixedVector(const FixedVector& other) { *this = other; }
  FixedVector(FixedVector&& other) noexcept { *this = other; }
  FixedVector& operator=(FixedVector&& other) noexcept {
    *this = other;
    return *this;
  }
  FixedVector& operator=(const FixedVector& other) {
    size_ = other.size_;
    std::copy_n(other.values_.begin(), size_, values_.begin());
    return *this;
  }

  void push_back(const T& value) { values_[size_++] = value; }
  void clear() { size_ = 0; }
  void resize(std::size_t size) { size_ = size; }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  static constexpr std::size_t capacity() { return Capacity; }
  bool full() const { return size_ == Capacity; }

  T& operator[](std::size_t i) { return values_[i]; }
  const T& operator[](std::size_t i) const { return values_[i]; }
  T* begin() { return values_.data(); }
  T* end() { return values_.data() + size_; }
  const T* begin() const { return values_.data(); }
  const T* end() const { return values_.data() + size_; }

 private:
  std::size_t size_ = 0;
  std::array<T, Capacity> values_;
};

/// A line of the image plane, negative on its inner side. The image is [0, 1] x [0, 1], (0, 0) its
/// top left corner; values are distances of a plane through the eye from points at view depth 1,
/// within a factor of sqrt(2).
struct ImageLine {
  double x;
  double y;
  double constant;
  /// The width of the interval [-band, 0] of values at which a sample may be on either side,
  /// because its ray does not pass exactly through the eye (`NearbyRays`).
  double band;

  double at(const glm::dvec2& point) const { return x * point.x + y * point.y + constant; }
};

/// A convex polygon on the image plane. The edges of a beam's pyramid are the directions from the
/// eye through its corners (thesis, section 3.2, keeps these as unit vectors).
using ImagePolygon = FixedVector<glm::dvec2, 24>;

/// The smallest and the largest value of a line over a polygon's corners.
struct LineRange {
  double low;
  double high;
};
inline LineRange range_over(const ImagePolygon& polygon, const ImageLine& line) {
  LineRange range{line.at(polygon[0]), 0.0};
  range.high = range.low;
  for (std::size_t i = 1; i < polygon.size(); ++i) {
    const double value = line.at(polygon[i]);
    range.low = std::min(range.low, value);
    range.high = std::max(range.high, value);
  }
  return range;
}

/// Returns the part of a nonempty polygon where the line is at most `slack` (Sutherland and
/// Hodgman, "Reentrant polygon clipping", CACM 17(1), 1974; one line per call). If another corner
/// does not fit, returns the whole polygon, which covers more than necessary.
inline ImagePolygon clip(const ImagePolygon& polygon, const ImageLine& line, double slack) {
  ImagePolygon part;
  glm::dvec2 last = polygon[polygon.size() - 1];
  double last_value = line.at(last) - slack;
  for (const glm::dvec2& corner : polygon) {
    const double value = line.at(corner) - slack;
    if ((value > 0.0) != (last_value > 0.0)) {
      if (part.full()) return polygon;
      part.push_back(last + (corner - last) * (last_value / (last_value - value)));
    }
    if (value <= 0.0) {
      if (part.full()) return polygon;
      part.push_back(corner);
    }
    last = corner;
    last_value = value;
  }
  return part;
}

/// Returns the area of a polygon; the whole image has the area 1.
inline double area(const ImagePolygon& polygon) {
  double twice = 0.0;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const glm::dvec2 a = polygon[i - 1] - polygon[0];
    const glm::dvec2 b = polygon[i] - polygon[0];
    twice += a.x * b.y - a.y * b.x;
  }
  return 0.5 * std::abs(twice);
}

}  // namespace beambench::accel::beam
