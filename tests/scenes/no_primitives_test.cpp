// Scenes without primitives are refused, whatever their source.

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "scenes/base/error.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/scenes/thrown_message.hpp"
#include "tests/temporary_folder.hpp"

namespace beambench::scenes {
namespace {

class NoPrimitives : public testing::Test {
 protected:
  std::string message(const std::string& name, const std::string& text) const {
    const std::string file = folder_.write(name, text).string();
    return thrown_message([&] { load_scene(file); });
  }

  TemporaryFolder folder_;
};

TEST_F(NoPrimitives, AreRefusedInNffWithTheReason) {
  EXPECT_TRUE(says(message("a.nff", "b 0 0 0\n"),
                   {"a.nff: the scene has no primitives; give it at least one sphere"}));
  EXPECT_TRUE(says(message("a.nff", "b 0 0 0\nsphere 0 0 0 1\n"),
                   {"a.nff: ", "no primitives", "a.nff:2: unknown word 'sphere'"}));
  EXPECT_TRUE(says(message("a.nff", "hello\n"), {"a.nff:1: ", "no NFF command"}));
  EXPECT_EQ(message("a.nff", "b 0 0 0\rs 0 0 0 1\r"), "(nothing thrown)");
}

TEST_F(NoPrimitives, AreRefusedWhenAllAreDegenerate) {
  struct Case {
    const char* text;
    const char* place;
    const char* why;
  };
  for (const Case& each : {Case{"b 0 0 0\n\ns 0 0 0 0\n", "a.nff:3: ", "radius is 0"},
                           Case{"c 0 0 0 0\n1 1 1 0\ns 0 0 0 0\n", "a.nff:1: ", "both radii are 0"},
                           Case{"c 1 1 1 1\n1 1 1 1\n", "a.nff:1: ", "same point"},
                           Case{"b 0 0 0\np 2\n0 0 0\n1 1 1\n", "a.nff:2: ", "at least 3"},
                           Case{"b 0 0 0\np 3\n0 0 0\n1 1 1\n2 2 2\n", "a.nff:2: ", "no area"},
                           Case{"p 3\n0 0 0\n0 0 0\n0 0 0\n", "a.nff:1: ", "only 1 of its 3"}}) {
    EXPECT_TRUE(says(message("a.nff", each.text), {"no primitives", each.place, each.why}))
        << each.text;
  }
  EXPECT_TRUE(says(message("a.nff", "s 0 0 0 0\ns 1 1 1 0\n"), {"(and 1 more)"}));
}

TEST_F(NoPrimitives, AreRefusedInMeshes) {
  for (const char* text : {"v 0 0 0\nv 1 0 0\nv 0 1 0\n", "v 0 0 0\nf 1 1 1\n", "# nothing\n"}) {
    EXPECT_TRUE(says(message("a.obj", text), {"a.obj: ", "no triangle is in it"})) << text;
  }
}

TEST_F(NoPrimitives, Utf16IsIdentified) {
  const std::string wide(
      "s\0 \0"
      "1\0 \0"
      "2\0 \0"
      "3\0 \0"
      "4\0\n\0",
      18);
  for (const std::string& text : {wide, "\xFF\xFE" + wide}) {
    EXPECT_TRUE(says(message("a.nff", text), {"a.nff: ", "UTF-16", "save it as UTF-8"}));
  }
}

/// Loads a plug-in's scene. Call this in a separate process, because it changes the catalogue.
void load_plugin_scene(const std::string& spec) {
  const auto nothing = [] { return SceneBuilder("nothing").build(); };
  register_plugin_scenes(
      {{"nothing", "Nothing", {}, [=](const Parameters&) { return nothing(); }, "", "plugin.so"}},
      {{".nothing", "Nothing",
        [=](const std::filesystem::path&, std::vector<std::string>&) { return nothing(); },
        "plugin.so"}});
  try {
    load_scene(spec);
  } catch (const InputError& error) {
    std::fputs(error.what(), stderr);
    std::exit(2);
  }
  std::exit(0);
}

TEST_F(NoPrimitives, AreRefusedFromGeneratorsAndReadersOfPlugIns) {
  testing::GTEST_FLAG(death_test_style) = "fast";
  EXPECT_EXIT(load_plugin_scene("nothing"), testing::ExitedWithCode(2),
              "nothing: the scene has no primitives; give it");
  EXPECT_EXIT(load_plugin_scene("a.nothing"), testing::ExitedWithCode(2),
              "a.nothing: the scene has no primitives; give it");
}

}  // namespace
}  // namespace beambench::scenes
