#include "scenes/formats/mesh/obj_writer.hpp"

#include <iterator>

#include <fmt/compile.h>
#include <fmt/format.h>

#include "scenes/base/error.hpp"

namespace beambench::scenes::mesh {

void write_obj(const Scene& scene, std::ostream& stream) {
  if (!scene.spheres.empty() || !scene.cones.empty()) {
    throw InputError(
        fmt::format("'{}' has {} spheres and {} cones, which OBJ cannot express; write it as .nff",
                    scene.name, scene.spheres.size(), scene.cones.size()));
  }
  constexpr std::size_t kBlock = 1U << 16U;  // bytes passed to the stream at a time
  fmt::memory_buffer buffer;
  const auto flush = [&] {
    stream.write(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    buffer.clear();
  };
  for (const glm::vec3& vertex : scene.vertices) {
    const glm::dvec3 place(vertex);  // a float's shortest text is not the double's
    fmt::format_to(std::back_inserter(buffer), FMT_COMPILE("v {} {} {}\n"), place.x, place.y,
                   place.z);
    if (buffer.size() >= kBlock) flush();
  }
  for (const Triangle& triangle : scene.triangles) {  // OBJ counts from 1
    fmt::format_to(std::back_inserter(buffer), FMT_COMPILE("f {} {} {}\n"), triangle.vertex[0] + 1,
                   triangle.vertex[1] + 1, triangle.vertex[2] + 1);
    if (buffer.size() >= kBlock) flush();
  }
  flush();
}

}  // namespace beambench::scenes::mesh
