#pragma once
// Vectors of exact numbers.

#include <glm/vec3.hpp>

#include "tests/verify/exact/number.hpp"

namespace beambench::exact {

struct Vector {
  Vector() = default;
  Vector(Number x, Number y, Number z) : x(std::move(x)), y(std::move(y)), z(std::move(z)) {}
  explicit Vector(const glm::dvec3& v) : x(v.x), y(v.y), z(v.z) {}

  glm::dvec3 rounded() const { return {x.rounded(), y.rounded(), z.rounded()}; }

  Number x, y, z;
};

inline Vector operator+(const Vector& a, const Vector& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vector operator-(const Vector& a, const Vector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vector operator*(const Number& s, const Vector& v) { return {s * v.x, s * v.y, s * v.z}; }

inline Number dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Number square(const Vector& a) { return dot(a, a); }
inline Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Returns the length, with an error of a few units in the last place.
inline double length(const Vector& a) { return std::sqrt(square(a).rounded()); }

}  // namespace beambench::exact
