#include "accel/tile_beam/pencil_bundle.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace beambench::accel::tile_beam {
namespace {

/// The maximum radius of a ball; places widened by it stay finite.
constexpr float kLargestRadius = 0x1p20F;
/// The number of a part's origins tested to determine whether bundling is worthwhile.
constexpr std::size_t kFirst = 512;

/// Returns the origins of a bundle with a ball that contains the apexes, allowing for the rounding
/// of rays toward them.
BundleRays bundle_rays(const BundlePart& part) {
  const std::span<const Pencil> pencils = part.pencils;
  glm::dvec3 lower = pencils.front().apex;
  glm::dvec3 upper = lower;
  for (const Pencil& pencil : pencils) {
    lower = glm::min(lower, pencil.apex);
    upper = glm::max(upper, pencil.apex);
  }
  BundleRays bundle{{part.hierarchy, part.scene, {}, {}, glm::vec3(0.5 * (lower + upper))},
                    0.0F,
                    {},
                    pencils.size(),
                    pencils.front().count};
  double farthest = 0.0;
  for (std::size_t i = 0; i < BundleRays::kApexes; ++i) {
    const Pencil& pencil = pencils[std::min(i, pencils.size() - 1)];
    for (int axis = 0; axis < 3; ++axis) {
      bundle.places[static_cast<std::size_t>(axis)][i] = static_cast<float>(pencil.apex[axis]);
    }
    farthest = std::max(farthest, glm::distance(pencil.apex, glm::dvec3(bundle.apex)));
  }
  // Directions are rounded: they miss the apex by up to 2^-23 of their length, and lengths are a
  // few times the size of the scene and of the apex's coordinates.
  const glm::dvec3 size = glm::max(glm::abs(lower), glm::abs(upper));
  const double coordinates =
      std::max({size.x, size.y, size.z, double{part.hierarchy.bounds.largest_coordinate()}});
  bundle.radius = static_cast<float>(farthest * (1.0 + 0x1p-20) + 0x1p-18 * coordinates);
  return bundle;
}

}  // namespace

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
bool find_hidden(const BundlePart& part, PencilUnit& unit, BundleMemory& memory,
                 std::span<std::uint8_t> hits, Counting& counting) {
  const std::size_t begin = part.pencils.front().first + part.first;
  memory.found.resize(part.count);
  BundleRays bundle = bundle_rays(part);
  if (!(bundle.radius < kLargestRadius)) return false;
  for (std::size_t done = 0; done < part.count;) {
    const std::size_t left = done == 0 ? std::min(kFirst, part.count) : part.count - done;
    bundle.rays = part.rays.subspan(begin + done, left);
    bundle.samples = part.samples.from(begin + done);
    const std::span<std::uint32_t> found = std::span(memory.found).subspan(done);
    const std::size_t count =
        part.kernels.queries<Counting>().bundle(bundle, unit, found, counting).count;
    if (done == 0 &&
        std::ranges::count(found.first(count), kOpen) * 2 > std::ssize(found.first(count))) {
      return false;
    }
    done += count;
  }
  memory.open.clear();
  for (std::size_t i = 0; i < part.count; ++i) {
    if (memory.found[i] == kOpen) memory.open.push_back(static_cast<std::uint32_t>(i));
  }
  for (std::size_t apex = 0; apex < part.pencils.size(); ++apex) {
    const std::span<std::uint8_t> own =
        hits.subspan(part.pencils[apex].first + part.first, part.count);
    for (std::size_t i = 0; i < part.count; ++i) {
      own[i] = static_cast<std::uint8_t>(memory.found[i] >> apex & 1U);
    }
  }
  counting.add("bundle_origins", part.count);
  counting.add("open_origins", memory.open.size());
  return true;
}

template bool find_hidden(const BundlePart&, PencilUnit&, BundleMemory&, std::span<std::uint8_t>,
                          NoCounting&);
template bool find_hidden(const BundlePart&, PencilUnit&, BundleMemory&, std::span<std::uint8_t>,
                          WorkCounters&);

}  // namespace beambench::accel::tile_beam
