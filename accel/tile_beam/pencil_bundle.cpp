#include "accel/tile_beam/pencil_bundle.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace beambench::accel::tile_beam {
namespace {

/// Finds what all pencils have in common, and lists the origins that are left.
template <class Counting>
void find_open(const BundlePart& part, BundleMemory& memory, Counting& counting) {
  const ApexBall ball(part.pencils, part.hierarchy.bounds);
  const std::size_t begin = part.pencils.front().first + part.first;
  memory.found.resize(part.count);
  for (std::size_t done = 0; done < part.count;) {
    const PencilRays origins{part.hierarchy,
                             part.scene,
                             part.rays.subspan(begin + done, part.count - done),
                             part.samples.from(begin + done),
                             ball.center,
                             ball.radius};
    const std::span<std::uint8_t> found = std::span(memory.found).subspan(done);
    done += part.kernels.queries<Counting>().bundle(origins, memory.unit, found, counting).count;
  }
  memory.open.clear();
  memory.samples.clear();
  for (std::size_t i = 0; i < part.count; ++i) {
    if (memory.found[i] != kUndecided) continue;
    memory.open.push_back(static_cast<std::uint32_t>(i));
    if (!part.samples.of_rays.empty()) {
      memory.samples.push_back(part.samples.of_rays[begin + i]);
    }
  }
  counting.add("bundle_origins", part.count);
  counting.add("open_origins", memory.open.size());
}

}  // namespace

ApexBall::ApexBall(std::span<const Pencil> pencils, const scenes::Bounds& scene) {
  glm::dvec3 lower = pencils.front().apex;
  glm::dvec3 upper = lower;
  for (const Pencil& pencil : pencils) {
    lower = glm::min(lower, pencil.apex);
    upper = glm::max(upper, pencil.apex);
  }
  center = glm::vec3(0.5 * (lower + upper));
  double farthest = 0.0;
  for (const Pencil& pencil : pencils) {
    farthest = std::max(farthest, glm::distance(glm::dvec3(center), pencil.apex));
  }
  // Directions are rounded: they pass beside the apex by up to 2^-23 of their length, and lengths
  // are a few sizes of the scene and of the apex's coordinates.
  const glm::dvec3 size = glm::max(glm::abs(lower), glm::abs(upper));
  const double coordinates = std::max({size.x, size.y, size.z, double{scene.largest_coordinate()}});
  radius = static_cast<float>(farthest * (1.0 + 0x1p-20) + 0x1p-18 * coordinates);
}

bool is_bundle(std::span<const Pencil> pencils) {
  if (pencils.size() < 2) return false;
  const std::size_t count = pencils.front().count;
  std::size_t next = pencils.front().first;
  for (const Pencil& pencil : pencils) {
    if (!pencil.toward || pencil.count != count || pencil.first != next) return false;
    next += count;
  }
  return true;
}

template <class Counting>
void trace_bundle(const BundlePart& part, BundleMemory& memory, std::span<std::uint8_t> hits,
                  Counting& counting) {
  find_open(part, memory, counting);
  const std::size_t open = memory.open.size();
  memory.rays.resize(open);
  memory.open_found.resize(open);
  PencilSamples samples = part.samples;
  samples.of_rays = memory.samples;
  for (const Pencil& pencil : part.pencils) {
    const std::size_t begin = pencil.first + part.first;
    const std::span<std::uint8_t> own = hits.subspan(begin, part.count);
    std::ranges::copy(memory.found, own.begin());
    for (std::size_t i = 0; i < open; ++i) memory.rays[i] = part.rays[begin + memory.open[i]];
    for (std::size_t done = 0; done < open;) {
      const PencilRays rays{part.hierarchy, part.scene, std::span(memory.rays).subspan(done),
                            samples.from(done), glm::vec3(pencil.apex)};
      const std::span<std::uint8_t> found = std::span(memory.open_found).subspan(done);
      done += part.kernels.queries<Counting>().any_hits(rays, memory.unit, found, counting).count;
    }
    for (std::size_t i = 0; i < open; ++i) own[memory.open[i]] = memory.open_found[i];
  }
}

template void trace_bundle(const BundlePart&, BundleMemory&, std::span<std::uint8_t>, NoCounting&);
template void trace_bundle(const BundlePart&, BundleMemory&, std::span<std::uint8_t>,
                           WorkCounters&);

}  // namespace beambench::accel::tile_beam
