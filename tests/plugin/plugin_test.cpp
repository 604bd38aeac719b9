// Plug-in internals; tests/python/test_plugins.py tests plug-ins from the outside.

#include "harness/plugin/plugin.hpp"

#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "harness/plugin/activity.hpp"
#include "harness/plugin/adapters/madmann91_hit.hpp"
#include "harness/plugin/load_plugin.hpp"
#include "harness/plugin/validation.hpp"
#include "scenes/base/error.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/random_scene.hpp"

namespace beambench::plugin {
namespace {

// Plug-ins compiled with other types are refused; the version number explains why.
TEST(PluginStamp, TheInterfaceVersionChangesWithTheTypes) {
#if defined(__x86_64__) && defined(__GLIBCXX__) && !defined(_GLIBCXX_DEBUG)
  constexpr std::uint64_t kLayoutOfVersion9 = 0xF77398A5F2829BE6;
  EXPECT_EQ(kPluginStamp.layout, kLayoutOfVersion9)
      << std::hex << kPluginStamp.layout
      << ": types of the interface have changed; increment kPluginInterface and write their "
         "fingerprint here";
#endif
  EXPECT_EQ(kPluginInterface, 9U);
}

TEST(PluginStamp, TheLayoutIsThatOfAllTypes) {
  struct Small {
    char c;
  };
  struct Large {
    char c[3];
  };
  struct alignas(4) Aligned {
    char c[4];
  };
  struct Whole {
    char c[4];
  };
  using plugin_stamp::layout_of;
  EXPECT_NE((plugin_stamp::layout_of<Small, Large>()), (plugin_stamp::layout_of<Large, Small>()));
  EXPECT_NE(plugin_stamp::layout_of<Aligned>(), plugin_stamp::layout_of<Whole>());
  EXPECT_EQ((plugin_stamp::layout_of<Small, Large>()), (plugin_stamp::layout_of<Small, Large>()));
}

// With the newer interface, an adapter written for the older one returned a leaf's last hit as the
// closest.
TEST(Madmann91Adapter, TakesTFromTheHitOrFindsItInTheRay) {
  struct {
    float tmax = 2.0F;
  } ray;
  adapters::end_at(ray, std::tuple(1.5F, 0.25F, 0.5F));
  EXPECT_EQ(ray.tmax, 1.5F);
  adapters::end_at(ray, std::pair(0.25F, 0.5F));
  EXPECT_EQ(ray.tmax, 1.5F) << "the older version stored t in the ray";
}

TEST(RequestedPlugins, AreRemovedFromAnywhereOnTheCommandLine) {
  ::unsetenv("BEAMBENCH_PLUGINS");
  std::vector<std::string> arguments{"beambench",     "--plugin", "a.so", "list", "--json",
                                     "--plugin=b.so", "--plugin", "a.so", "--",   "--plugin"};
  EXPECT_EQ(take_requested_plugins(arguments), (std::vector<std::string>{"a.so", "b.so"}));
  EXPECT_EQ(arguments, (std::vector<std::string>{"beambench", "list", "--json", "--", "--plugin"}));
}

TEST(RequestedPlugins, TheEnvironmentComesFirst) {
  ::setenv("BEAMBENCH_PLUGINS", "/x/a.so::/y/b.so", 1);
  std::vector<std::string> arguments{"beambench", "--plugin", "c.so"};
  EXPECT_EQ(take_requested_plugins(arguments),
            (std::vector<std::string>{"/x/a.so", "/y/b.so", "c.so"}));
  ::unsetenv("BEAMBENCH_PLUGINS");
}

TEST(Activity, KeepsLinesApartAndTruncatesLongOnes) {
  Activity activity;
  activity.write(Activity::Line::kForeign, "asking ", "'mine'");
  activity.write(Activity::Line::kCell, std::string(10'000, 'x'));
  EXPECT_EQ(activity.read(Activity::Line::kForeign), "asking 'mine'");
  EXPECT_EQ(activity.read(Activity::Line::kCell), std::string(4095, 'x'));
  activity.clear(Activity::Line::kForeign);
  EXPECT_EQ(activity.read(Activity::Line::kForeign), "");
}

TEST(CheckScene, AcceptsScenesFromTheBuilder) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    EXPECT_NO_THROW(check_scene(tests::random_scene(seed, 50))) << seed;
  }
  EXPECT_NO_THROW(check_scene(scenes::SceneBuilder("empty").build()));
}

TEST(CheckScene, RefusesInvalidIndicesAndNumbers) {
  const scenes::Scene sound = tests::random_scene(7, 60);
  ASSERT_FALSE(sound.spheres.empty());
  ASSERT_FALSE(sound.cones.empty());
  ASSERT_FALSE(sound.polygons.empty());
  const auto refuses = [&](auto change) {
    scenes::Scene scene = sound;
    change(scene);
    EXPECT_THROW(check_scene(scene), PluginError);
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  refuses([](scenes::Scene& s) { s.primitives[3].index = 10'000; });
  refuses([](scenes::Scene& s) { s.primitives[3].surface = 10'000; });
  refuses([](scenes::Scene& s) { s.primitives[3].kind = static_cast<scenes::PrimitiveKind>(7); });
  refuses([](scenes::Scene& s) { s.spheres[0].radius = 0.0F; });
  refuses([&](scenes::Scene& s) { s.spheres[0].center.y = nan; });
  refuses([](scenes::Scene& s) { s.cones[0].apex = s.cones[0].base; });
  refuses([](scenes::Scene& s) { s.polygons[0].first_corner = 1'000'000; });
  refuses([](scenes::Scene& s) { s.polygons[0].triangle_count = 0; });
  refuses([](scenes::Scene& s) { s.triangles[0].vertex[1] = 1'000'000; });
  refuses([](scenes::Scene& s) { s.triangles[0].primitive += 1; });
  refuses([](scenes::Scene& s) { s.vertices[0].x = 2e9F; });
  refuses([](scenes::Scene& s) { s.bounds.upper.x += 1.0F; });
  refuses([](scenes::Scene& s) { s.cameras.clear(); });
  refuses([](scenes::Scene& s) { s.cameras.front().angle = 0.0F; });
}

TEST(CheckScene, RefusesASceneThatIsTooSmall) {
  scenes::SceneBuilder builder("small");
  builder.add_sphere({0.0, 0.0, 0.0}, 1.0);
  scenes::Scene scene = std::move(builder).build();
  const auto resize = [&](float radius) {
    scene.spheres[0].radius = radius;
    scene.bounds = scenes::primitive_bounds(scene, 0);
  };
  resize(1e-8F);
  EXPECT_NO_THROW(check_scene(scene));
  resize(1e-15F);
  EXPECT_THROW(check_scene(scene), PluginError);
}

}  // namespace
}  // namespace beambench::plugin
