#include "accel/beam/sample_lattice.hpp"

namespace beambench::accel::beam {

std::vector<SampleLattice> sample_lattices(const PrimaryRays& rays, bool share_corners) {
  std::vector<SampleLattice> lattices;
  std::optional<SampleLattice> corners;
  for (int sample = 0; sample < rays.samples(); ++sample) {
    const glm::dvec2 offset = rays.offsets()[static_cast<std::size_t>(sample)];
    const bool corner =
        (offset.x == 0.0 || offset.x == 1.0) && (offset.y == 0.0 || offset.y == 1.0);
    if (share_corners && corner) {
      if (!corners) corners = SampleLattice{{}, rays.width() + 1, rays.height() + 1, {}};
      corners->places.push_back({static_cast<int>(offset.x), static_cast<int>(offset.y), sample});
    } else {
      lattices.push_back({offset, rays.width(), rays.height(), {{0, 0, sample}}});
    }
  }
  if (corners) lattices.push_back(*corners);
  return lattices;
}

std::vector<SampleLattice> part_of(std::span<const SampleLattice> lattices, const HitSpan& buffer,
                                   const PixelRect& part) {
  std::vector<SampleLattice> parts(lattices.begin(), lattices.end());
  for (SampleLattice& lattice : parts) {
    lattice.begin = {part.left, part.top};
    // Shared corners beyond the last pixel belong to the last part.
    if (part.left + part.width < buffer.width()) lattice.width = part.left + part.width;
    if (part.top + part.height < buffer.height()) lattice.height = part.top + part.height;
  }
  return parts;
}

}  // namespace beambench::accel::beam
