// The SPD's own output (tests/golden/spd) compared with ours, coordinate by coordinate, to the six
// printed digits.

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "scenes/catalogue.hpp"
#include "scenes/formats/nff/nff_reader.hpp"

namespace beambench::scenes {
namespace {

/// Returns the numbers that NFF prints for a primitive, in one list.
std::vector<float> numbers(const Scene& scene, PrimitiveId id, bool sorted_corners) {
  const Primitive& primitive = scene.primitives[id];
  if (primitive.kind == PrimitiveKind::kSphere) {
    const Sphere& sphere = scene.spheres[primitive.index];
    return {sphere.center.x, sphere.center.y, sphere.center.z, sphere.radius};
  }
  const Polygon& polygon = scene.polygons[primitive.index];
  std::vector<std::vector<float>> corners;
  for (std::uint32_t i = 0; i < polygon.corner_count; ++i) {
    const glm::vec3 p = scene.vertices[scene.corners[polygon.first_corner + i]];
    corners.push_back({p.x, p.y, p.z});
    if (polygon.first_normal == Polygon::kFlat) continue;
    const glm::vec3 n = scene.normals[polygon.first_normal + i];
    corners.back().insert(corners.back().end(), {n.x, n.y, n.z});
  }
  if (sorted_corners) std::sort(corners.begin(), corners.end());
  std::vector<float> all;
  for (const auto& corner : corners) all.insert(all.end(), corner.begin(), corner.end());
  return all;
}

/// Returns whether our number would be printed like the SPD's: both are equal within half a unit of
/// the sixth digit plus the rounding of both to float. Numbers that the SPD printed as about 1e-15
/// count as 0.
bool agrees(float ours, float printed) {
  const double size = std::abs(double{printed});
  if (size < 1e-13) return std::abs(ours) < 1e-12F;
  const double half_unit = 0.5 * std::pow(10.0, std::floor(std::log10(size)) - 5.0);
  return std::abs(double{ours} - double{printed}) <= half_unit + 1.2e-7 * size;
}

bool agree(const std::vector<float>& ours, const std::vector<float>& printed) {
  return std::equal(ours.begin(), ours.end(), printed.begin(), printed.end(), agrees);
}

bool same_surface(const Surface& ours, const Surface& printed) {
  return ours.color == printed.color && ours.diffuse == printed.diffuse &&
         ours.specular == printed.specular && ours.transmittance == printed.transmittance &&
         (ours.specular == 0.0F || agrees(ours.shine, printed.shine));
}

struct Golden {
  const char* file;
  const char* spec;
  bool whole;     ///< the file has all primitives
  bool in_order;  ///< our primitives are in the SPD's order, and polygons begin at the same corner
};

void PrintTo(const Golden& golden, std::ostream* stream) { *stream << golden.file; }

Scene printed_scene(std::string_view file) {
  return nff::read_nff(std::filesystem::path(BEAMBENCH_TEST_FILES) / "golden/spd" / file).scene;
}

class SpdOutput : public testing::TestWithParam<Golden> {
 protected:
  Scene printed_ = printed_scene(GetParam().file);
  Scene ours_ = load_scene(GetParam().spec);
};

TEST_P(SpdOutput, MatchesOurPrimitives) {
  const Golden& golden = GetParam();
  ASSERT_GE(printed_.primitives.size(), 8U) << "the golden file is cut short";
  if (golden.whole) {
    EXPECT_EQ(printed_.primitives.size(), ours_.primitives.size());
  }
  std::vector<std::vector<float>> left;
  for (PrimitiveId id = 0; id < ours_.primitives.size(); ++id) {
    left.push_back(numbers(ours_, id, !golden.in_order));
  }
  std::size_t next = 0;
  for (PrimitiveId id = 0; id < printed_.primitives.size(); ++id) {
    const std::vector<float> wanted = numbers(printed_, id, !golden.in_order);
    const auto from = left.begin() + static_cast<std::ptrdiff_t>(golden.in_order ? next : 0);
    const auto found =
        std::find_if(from, left.end(), [&](const auto& ours) { return agree(ours, wanted); });
    ASSERT_NE(found, left.end()) << "primitive " << id << " of " << golden.file;
    const auto ours = static_cast<std::size_t>(found - left.begin());
    const auto surface = [](const Scene& scene, std::size_t i) {
      return scene.surfaces[scene.primitives[i].surface];
    };
    if (printed_.surfaces.front() != Surface{}) {
      EXPECT_TRUE(same_surface(surface(ours_, ours), surface(printed_, id))) << id;
    }
    next = ours + 1;
    found->clear();  // each of our primitives may match only one
  }
}

TEST_P(SpdOutput, MatchesOurCameraLightsAndBackground) {
  const Camera& a = ours_.cameras.front();
  const Camera& b = printed_.cameras.front();
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_TRUE(agrees(a.from[axis], b.from[axis]));
    EXPECT_TRUE(agrees(a.at[axis], b.at[axis]));
    EXPECT_TRUE(agrees(a.up[axis], b.up[axis]));
  }
  EXPECT_EQ(a.angle, b.angle);
  EXPECT_EQ(a.hither, b.hither);
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(ours_.background, printed_.background);
  if (printed_.lights.empty()) return;  // left out of the file
  ASSERT_EQ(ours_.lights.size(), printed_.lights.size());
  for (std::size_t i = 0; i < ours_.lights.size(); ++i) {
    EXPECT_EQ(ours_.lights[i].position, printed_.lights[i].position);
    EXPECT_EQ(ours_.lights[i].color, printed_.lights[i].color);
  }
}

INSTANTIATE_TEST_SUITE_P(Spd, SpdOutput,
                         testing::Values(Golden{"balls-2.nff", "balls:n=2", true, false},
                                         Golden{"tetra-6.nff", "tetra:n=6", false, false},
                                         Golden{"shells-2.nff", "shells:n=2", false, true},
                                         Golden{"teapot-2.nff", "teapot:n=2", false, true},
                                         Golden{"teapot-6.nff", "teapot:n=6", false, true}),
                         [](const auto& info) {
                           const std::string_view file = info.param.file;
                           std::string name(file.substr(0, file.find('.')));
                           std::erase(name, '-');
                           return name;
                         });

TEST(SpdShells, BeginsAndEndsWhereTheSpdDoes) {
  const Scene printed = printed_scene("shells-2.nff");
  const Scene ours = load_scene("shells:n=2");
  EXPECT_TRUE(agree(numbers(ours, 0, false), numbers(printed, 0, false)));
  EXPECT_TRUE(agree(numbers(ours, 720, false), numbers(printed, 79, false)));
}

}  // namespace
}  // namespace beambench::scenes
