#include "accel/beam/drifting_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace beambench::accel::beam {
namespace {

using glm::dmat3;
using glm::dvec2;
using glm::dvec3;

dvec2 position(const PrimaryRays& image, const SamplePlace& place) {
  return (dvec2(place.pixel) + image.offsets()[place.sample]) /
         dvec2(image.width(), image.height());
}

/// A linear function of a place relative to the center: constant + across * x + down * y.
template <class Value>
struct Linear {
  Value constant{0.0};
  Value across{0.0};
  Value down{0.0};

  Value at(const dvec2& place) const { return constant + across * place.x + down * place.y; }
};

/// Fits linear functions to values at given places by least squares.
class Regression {
 public:
  explicit Regression(std::span<const dvec2> places) : places_(places) {
    dmat3 sums(0.0);
    for (const dvec2& place : places) {
      const dvec3 row(1.0, place);
      sums += glm::outerProduct(row, row);
    }
    is_regular_ = glm::determinant(sums) > 1e-9 * sums[0][0] * sums[1][1] * sums[2][2];
    inverse_ = glm::inverse(sums);
  }

  /// Returns whether the places are not all near one line.
  bool is_regular() const { return is_regular_; }

  /// Returns the best fit to `value(i)` at the i-th place.
  template <class Value, class Of>
  Linear<Value> of(Of value) const {
    std::array<Value, 3> sums{Value(0.0), Value(0.0), Value(0.0)};
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const Value here = value(i);
      sums[0] += here;
      sums[1] += here * places_[i].x;
      sums[2] += here * places_[i].y;
    }
    const auto combined = [&](int row) {
      return sums[0] * inverse_[0][row] + sums[1] * inverse_[1][row] + sums[2] * inverse_[2][row];
    };
    return {combined(0), combined(1), combined(2)};
  }

 private:
  std::span<const dvec2> places_;
  dmat3 inverse_{0.0};
  bool is_regular_;
};

/// Returns the point closest to the rays' lines; for parallel lines, a point far behind them.
dvec3 nearest_to_lines(std::span<const Ray> rays, const dvec3& ahead) {
  constexpr double kFaint = 1e-9;
  constexpr double kFar = 1e4;
  dmat3 sums(0.0);
  dvec3 sum(0.0);
  dvec3 middle(0.0);
  double size = 0.0;
  for (const Ray& ray : rays) {
    const dvec3 direction = glm::normalize(dvec3(ray.direction));
    const dmat3 across = dmat3(1.0) - glm::outerProduct(direction, direction);
    sums += across;
    sum += across * dvec3(ray.origin);
    middle += dvec3(ray.origin) / static_cast<double>(rays.size());
    size = std::max(size, glm::length(dvec3(ray.origin) - dvec3(rays.front().origin)));
  }
  const double weight = kFaint * static_cast<double>(rays.size());
  sums += weight * glm::outerProduct(ahead, ahead);
  sum += weight * ahead * glm::dot(ahead, middle - kFar * size * ahead);
  return glm::inverse(sums) * sum;
}

/// Returns the directions of an image that best fit those of rays: a projective function of the
/// place, up to a factor. Each direction s satisfies s (1 + tilt . p) = constant + ... , so the
/// tilt is the solution of two equations, and the other coefficients depend on it linearly.
Linear<dvec3> projective_directions(std::span<const Ray> rays, std::span<const dvec2> places,
                                    const Regression& regression, const dvec3& ahead) {
  std::vector<dvec3> flat(rays.size());  // at view depth 1 as seen along `ahead`
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const dvec3 direction(rays[i].direction);
    flat[i] = direction / glm::dot(direction, ahead) - ahead;
  }
  const std::array<Linear<dvec3>, 3> functions{
      regression.of<dvec3>([&](std::size_t i) { return flat[i]; }),
      regression.of<dvec3>([&](std::size_t i) { return flat[i] * places[i].x; }),
      regression.of<dvec3>([&](std::size_t i) { return flat[i] * places[i].y; })};
  glm::dmat2 sums(0.0);
  dvec2 sum(0.0);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const dvec2& at = places[i];
    const dvec3 rest = flat[i] - functions[0].at(at);
    const dvec3 by_x = flat[i] * at.x - functions[1].at(at);
    const dvec3 by_y = flat[i] * at.y - functions[2].at(at);
    sums += glm::dmat2(glm::dot(by_x, by_x), glm::dot(by_x, by_y), glm::dot(by_x, by_y),
                       glm::dot(by_y, by_y));
    sum -= dvec2(glm::dot(by_x, rest), glm::dot(by_y, rest));
  }
  dvec2 tilt = glm::inverse(sums) * sum;
  if (!std::isfinite(tilt.x) || !std::isfinite(tilt.y)) tilt = dvec2(0.0);
  const auto combined = [&](const dvec3 Linear<dvec3>::*part) {
    return functions[0].*part + tilt.x * functions[1].*part + tilt.y * functions[2].*part;
  };
  return {ahead + combined(&Linear<dvec3>::constant),
          tilt.x * ahead + combined(&Linear<dvec3>::across),
          tilt.y * ahead + combined(&Linear<dvec3>::down)};
}

}  // namespace

/// Scales the ray's direction to view depth 1, like that of the sample.
Course DriftingView::course_of(const Ray& ray, const SamplePlace& place) const {
  const dvec3 from = dvec3(ray.origin) - eye;
  const dvec3 direction(ray.direction);
  const double start = glm::dot(image.forward(), from);
  const double speed = glm::dot(image.forward(), direction);
  if (!(speed > 0.0 && start > 0.0)) {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    return {start, kNever, kNever, kNever, kNever, kNever};
  }
  const dvec3 scaled = direction / speed;
  const dvec2 at = dvec2(place.pixel) + image.offsets()[place.sample];
  const dvec2 step = position(image, place) - center;
  const double turned =
      glm::length(scaled - (image.top_left() + image.right() * at.x + image.down() * at.y));
  const dvec3 beside = from - start * scaled;
  const dvec3 drifted = drift[0] * step.x + drift[1] * step.y;
  return {start,
          turned + glm::length(beside - drifted) / start,
          turned + glm::length(beside) / start,
          glm::length(beside),
          glm::length(drifted),
          glm::length(image.across() * step.x + image.all_down() * step.y)};
}

double DriftingView::pixel() const {
  return std::min(glm::length(image.right()), glm::length(image.down()));
}

std::optional<DriftingView> fitted_view(std::span<const Ray> rays,
                                        std::span<const std::uint32_t> samples,
                                        const PrimaryRays& image) {
  std::vector<dvec2> places(rays.size());
  dvec2 center(0.0);
  dvec3 sum(0.0);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    places[i] = position(image, place_in(image, samples[i]));
    center += places[i] / static_cast<double>(rays.size());
    sum += glm::normalize(dvec3(rays[i].direction));
  }
  for (dvec2& place : places) place -= center;
  const dvec3 ahead = glm::normalize(sum);
  for (const Ray& ray : rays) {
    if (!(glm::dot(ahead, dvec3(ray.direction)) > 0.1 * glm::length(dvec3(ray.direction)))) {
      return std::nullopt;
    }
  }
  const Regression regression(places);
  if (!regression.is_regular()) return std::nullopt;
  const Linear<dvec3> directions = projective_directions(rays, places, regression, ahead);
  DriftingView view{
      image.with_directions(directions.at(-center), directions.across, directions.down),
      nearest_to_lines(rays, ahead), center};
  // The eye drifts within the plane across the view.
  const auto drift = regression.of<dvec3>([&](std::size_t i) {
    const dvec3 from = dvec3(rays[i].origin) - view.eye;
    const dvec3 direction(rays[i].direction);
    const dvec3& axis = view.image.forward();
    return from - glm::dot(axis, from) / glm::dot(axis, direction) * direction;
  });
  view.eye += drift.constant;
  view.drift = {drift.across, drift.down};
  return view;
}

}  // namespace beambench::accel::beam
