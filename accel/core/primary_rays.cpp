#include "accel/core/primary_rays.hpp"

#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "scenes/base/error.hpp"

namespace beambench::accel {

namespace {

constexpr int kMaxSide = 16384;
constexpr int kMaxGrid = 16;

}  // namespace

std::vector<glm::dvec2> sample_offsets(int samples) {
  if (samples == 5) {
    return {{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}, {1.0, 1.0}, {0.5, 0.5}};
  }
  for (int n = 1; n <= kMaxGrid; ++n) {
    if (n * n != samples) continue;
    std::vector<glm::dvec2> offsets;
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) offsets.emplace_back((i + 0.5) / n, (j + 0.5) / n);
    }
    return offsets;
  }
  throw InputError(
      fmt::format("{} samples per pixel have no pattern; expected 5 (corners and center) or n x n "
                  "with n from 1 "
                  "to {}",
                  samples, kMaxGrid));
}

PrimaryRays::PrimaryRays(const scenes::Camera& camera, int width, int height, int samples)
    : width_(width), height_(height), offsets_(sample_offsets(samples)), eye_(camera.from) {
  if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide) {
    throw InputError(fmt::format("resolution is {}x{}; expected 1 to {} pixels per side", width,
                                 height, kMaxSide));
  }
  forward_ = glm::normalize(glm::dvec3(camera.at) - glm::dvec3(camera.from));
  const glm::dvec3 right = glm::normalize(glm::cross(forward_, glm::dvec3(camera.up)));
  const glm::dvec3 up = glm::cross(right, forward_);
  constexpr double kRadiansPerDegree = 3.14159265358979323846 / 180.0;
  const double half_height = std::tan(0.5 * camera.angle * kRadiansPerDegree);
  const double half_width = half_height * camera.aspect;
  right_ = right * (2.0 * half_width / width);
  down_ = -up * (2.0 * half_height / height);
  across_ = right * (2.0 * half_width);
  all_down_ = -up * (2.0 * half_height);
  top_left_ = forward_ - right * half_width + up * half_height;
}

PrimaryRays PrimaryRays::mirrored(const glm::dvec3& point, const glm::dvec3& normal) const {
  PrimaryRays rays = *this;
  rays.eye_ = glm::vec3(point + beambench::accel::mirrored(glm::dvec3(eye_) - point, normal));
  for (glm::dvec3* direction : {&rays.forward_, &rays.top_left_, &rays.right_, &rays.down_,
                                &rays.across_, &rays.all_down_}) {
    *direction = beambench::accel::mirrored(*direction, normal);
  }
  return rays;
}

PrimaryRays PrimaryRays::with_directions(const glm::dvec3& top_left, const glm::dvec3& across,
                                         const glm::dvec3& all_down) const {
  PrimaryRays rays = *this;
  const glm::dvec3 middle = top_left + 0.5 * (across + all_down);
  rays.forward_ = glm::normalize(glm::cross(across, all_down));
  if (glm::dot(rays.forward_, middle) < 0.0) rays.forward_ = -rays.forward_;
  const double depth = glm::dot(rays.forward_, middle);
  rays.top_left_ = top_left / depth;
  rays.across_ = across / depth;
  rays.all_down_ = all_down / depth;
  rays.right_ = rays.across_ / static_cast<double>(width_);
  rays.down_ = rays.all_down_ / static_cast<double>(height_);
  return rays;
}

PrimaryRays PrimaryRays::at_corners() const {
  PrimaryRays rays = *this;
  rays.offsets_ = {glm::dvec2(0.0)};
  ++rays.width_;
  ++rays.height_;
  rays.across_ += right_;
  rays.all_down_ += down_;
  return rays;
}

std::size_t PrimaryRays::count() const {
  return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) * offsets_.size();
}

}  // namespace beambench::accel
