#include "scenes/base/portable_math.hpp"

#include <cmath>

namespace beambench {
namespace {

/// pi/2 and ln 2 in two parts (Cody and Waite 1980): the first has trailing zeros, so that its
/// product with a small integer is exact.
constexpr double kHalfPiHigh = 0x1.921fb544p+0;
constexpr double kHalfPiLow = 0x1.0b4611a626331p-34;
constexpr double kLn2High = 0x1.62e42feep-1;
constexpr double kLn2Low = 0x1.a39ef35793c76p-33;

/// A number reduced by a multiple of (high + low): the rest, and the multiple that was subtracted.
struct Reduced {
  double rest;
  long multiple;
};

Reduced reduce(double x, double high, double low) {
  const double multiple = std::floor(x / high + 0.5);
  return {(x - multiple * high) - multiple * low, static_cast<long>(multiple)};
}

/// Returns the sum of (-1)^k x^(2k) / (first (first + 1) ... (first + 2k - 1)): the Taylor series
/// of cos x for first = 1 and of sin x / x for first = 2.
double alternating_series(double x, int first) {
  constexpr int kTerms = 11;  // the next term is below 1e-23 for |x| <= pi/4
  double sum = 1.0;
  for (int k = kTerms; k >= 1; --k) {
    const int i = first + 2 * (k - 1);
    sum = 1.0 - sum * x * x / (static_cast<double>(i) * (i + 1));
  }
  return sum;
}

/// Returns the sine of the angle plus `quarters` quarter turns.
double sine(double radians, long quarters) {
  const auto [rest, multiple] = reduce(radians, kHalfPiHigh, kHalfPiLow);
  const long quadrant = ((multiple + quarters) % 4 + 4) % 4;
  const double size =
      quadrant % 2 == 0 ? rest * alternating_series(rest, 2) : alternating_series(rest, 1);
  return quadrant < 2 ? size : -size;
}

}  // namespace

double portable_sin(double radians) { return sine(radians, 0); }

double portable_cos(double radians) { return sine(radians, 1); }

double portable_exp(double x) {
  constexpr int kTerms = 16;  // the next term is below 1e-22 for |x| <= ln(2) / 2
  const auto [rest, multiple] = reduce(x, kLn2High, kLn2Low);
  double sum = 1.0;
  for (int k = kTerms; k >= 1; --k) sum = 1.0 + sum * rest / k;
  return std::ldexp(sum, static_cast<int>(multiple));
}

double portable_log(double x) {
  constexpr int kLastPower = 25;  // the next term is below 1e-21
  int exponent = 0;
  double mantissa = std::frexp(x, &exponent);
  if (mantissa < 0.7) {
    mantissa *= 2.0;
    --exponent;
  }
  // ln m = 2 artanh s for s = (m - 1) / (m + 1), |s| < 0.18.
  const double s = (mantissa - 1.0) / (mantissa + 1.0);
  double sum = 1.0 / kLastPower;
  for (int power = kLastPower - 2; power >= 1; power -= 2) sum = 1.0 / power + sum * s * s;
  return exponent * kLn2High + (exponent * kLn2Low + 2.0 * s * sum);
}

}  // namespace beambench
