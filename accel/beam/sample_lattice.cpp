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

}  // namespace beambench::accel::beam
