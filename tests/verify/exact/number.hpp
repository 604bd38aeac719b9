#pragma once
// Exact numbers: integers times powers of two, and signs of expressions with square roots.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include <gmpxx.h>

namespace beambench::exact {

/// An integer times a power of two, such as every finite double. Sums, differences and products are
/// exact. Division is not needed: quotients are compared by cross-multiplication.
class Number {
 public:
  Number() = default;
  /// `value` must be finite.
  Number(double value) {  // NOLINT(google-explicit-constructor): no information is lost
    if (value == 0.0) return;
    int exponent = 0;
    const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), 53));
    const int zeros = std::countr_zero(static_cast<std::uint64_t>(mantissa));
    mantissa_ = static_cast<long>(mantissa / (std::int64_t{1} << zeros));
    exponent_ = exponent - 53 + zeros;
  }

  int sign() const { return sgn(mantissa_); }
  Number abs() const { return {::abs(mantissa_), exponent_}; }
  Number squared() const { return *this * *this; }
  Number times_two_to(int power) const { return {mantissa_, exponent_ + power}; }

  /// Returns the number as a double, rounded toward zero. The exponent must be in the range of
  /// double.
  double rounded() const {
    long exponent = 0;
    const double mantissa = mpz_get_d_2exp(&exponent, mantissa_.get_mpz_t());
    return std::ldexp(mantissa, static_cast<int>(exponent) + exponent_);
  }

  friend Number operator-(const Number& a) { return {-a.mantissa_, a.exponent_}; }
  friend Number operator+(const Number& a, const Number& b) {
    if (a.sign() == 0) return b;
    if (b.sign() == 0) return a;
    const int exponent = std::min(a.exponent_, b.exponent_);
    return {a.shifted_to(exponent) + b.shifted_to(exponent), exponent};
  }
  friend Number operator-(const Number& a, const Number& b) { return a + -b; }
  friend Number operator*(const Number& a, const Number& b) {
    return {a.mantissa_ * b.mantissa_, a.exponent_ + b.exponent_};
  }
  friend bool operator==(const Number& a, const Number& b) { return (a - b).sign() == 0; }
  friend bool operator<(const Number& a, const Number& b) { return (a - b).sign() < 0; }
  friend bool operator<=(const Number& a, const Number& b) { return (a - b).sign() <= 0; }
  friend bool operator>(const Number& a, const Number& b) { return b < a; }
  friend bool operator>=(const Number& a, const Number& b) { return b <= a; }

 private:
  Number(mpz_class mantissa, int exponent) : mantissa_(std::move(mantissa)), exponent_(exponent) {}

  mpz_class shifted_to(int exponent) const {
    return mantissa_ << static_cast<mp_bitcnt_t>(exponent_ - exponent);
  }

  mpz_class mantissa_;
  int exponent_ = 0;
};

/// Returns the sign of a + b sqrt(d), d >= 0.
inline int sign_with_root(const Number& a, const Number& b, const Number& d) {
  const int rational = a.sign();
  const int root = d.sign() == 0 ? 0 : b.sign();
  if (rational == 0) return root;
  if (root == 0 || root == rational) return rational;
  return rational * (a.squared() - b.squared() * d).sign();
}

/// Returns the sign of a + b sqrt(d) + c sqrt(e), d and e >= 0.
inline int sign_with_roots(const Number& a, const Number& b, const Number& d, const Number& c,
                           const Number& e) {
  const int first = sign_with_root(a, b, d);
  const int second = e.sign() == 0 ? 0 : c.sign();
  if (first == 0) return second;
  if (second == 0 || second == first) return first;
  // Of opposite signs: the larger square decides.
  const Number rational = a.squared() + b.squared() * d - c.squared() * e;
  return first * sign_with_root(rational, Number(2.0) * a * b, d);
}

/// The number (p + q sqrt(d)) / w, with d >= 0 and w > 0; rational if d = 0.
struct Root {
  Number p;
  Number q;
  Number d;
  Number w;

  /// Returns the number as a double, without cancellation: the error is a few units in the last
  /// place.
  double rounded() const {
    const double root = std::sqrt(d.rounded());
    const double rational = p.rounded();
    const double irrational = q.rounded() * root;
    if (rational * irrational >= 0.0) return (rational + irrational) / w.rounded();
    return (p.squared() - q.squared() * d).rounded() / (rational - irrational) / w.rounded();
  }
};

/// Returns the sign of root - number.
inline int compare(const Root& root, const Number& number) {
  return sign_with_root(root.p - number * root.w, root.q, root.d);
}

/// Returns the sign of a - b.
inline int compare(const Root& a, const Root& b) {
  return sign_with_roots(a.p * b.w - b.p * a.w, a.q * b.w, a.d, -(b.q * a.w), b.d);
}

}  // namespace beambench::exact
