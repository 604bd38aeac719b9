#include "scenes/modelling/square_ring.hpp"

namespace beambench::scenes::modelling {

PolygonMesh square_ring(double half, double hole, double bottom, double top) {
  PolygonMesh mesh;
  for (const double z : {bottom, top}) {
    for (const double size : {half, hole}) {
      mesh.vertices.insert(
          mesh.vertices.end(),
          {{-size, -size, z}, {size, -size, z}, {size, size, z}, {-size, size, z}});
    }
  }
  for (std::uint32_t i = 0; i < 4; ++i) {  // outer corners i, inner ones 4 + i, the upper 8 more
    const std::uint32_t next = (i + 1) % 4;
    mesh.polygons.push_back({i, next, next + 8, i + 8});
    mesh.polygons.push_back({i + 8, next + 8, next + 12, i + 12});
    mesh.polygons.push_back({next + 4, i + 4, i + 12, next + 12});
    mesh.polygons.push_back({next, i, i + 4, next + 4});
  }
  return mesh;
}

}  // namespace beambench::scenes::modelling
