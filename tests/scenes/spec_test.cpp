#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "scenes/base/nearest_name.hpp"
#include "scenes/base/parameters.hpp"
#include "tests/scenes/thrown_message.hpp"

namespace beambench::scenes {
namespace {

/// Returns a spec as a user would type it.
std::string typed(const Spec& spec) {
  std::string text = spec.name;
  for (std::size_t i = 0; i < spec.parameters.size(); ++i) {
    text += i == 0 ? ':' : ',';
    text += spec.parameters[i].first;
    text += '=';
    text += spec.parameters[i].second;
  }
  return text;
}

TEST(Spec, IsANameWithParameters) {
  const Spec spec = parse_spec("samet:max_level=6,max_objects=0");
  EXPECT_EQ(spec.name, "samet");
  ASSERT_EQ(spec.parameters.size(), 2U);
  EXPECT_EQ(spec.parameters[0], (std::pair<std::string, std::string>("max_level", "6")));
  EXPECT_EQ(spec.parameters[1], (std::pair<std::string, std::string>("max_objects", "0")));
  EXPECT_TRUE(parse_spec("balls").parameters.empty());
}

TEST(Spec, MalformedTextIsRefusedWithTheForm) {
  for (const char* text :
       {"", ":n=1", "a:", "a:n", "a:=1", "a:n=", "a:n=1,", "a:,n=1", "a:n=1,,m=2", "a=1", "a,b"}) {
    EXPECT_TRUE(says(thrown_message([&] { parse_spec(text); }), {text, "name:key=value"})) << text;
  }
  EXPECT_TRUE(says(thrown_message([] { parse_spec("a:n=1,m=2,n=3"); }), {"'n' is given twice"}));
}

TEST(SpecList, CommasSeparateSpecsAndParameters) {
  const auto specs = parse_spec_list("a:x=1,y=2,b,c:z=3,d");
  ASSERT_EQ(specs.size(), 4U);
  EXPECT_EQ(typed(specs[0]), "a:x=1,y=2");
  EXPECT_EQ(typed(specs[1]), "b");
  EXPECT_EQ(typed(specs[2]), "c:z=3");
  EXPECT_EQ(typed(specs[3]), "d");
}

TEST(SpecList, EmptyPlacesAreRefused) {
  for (const char* text : {"", ",", "a,", ",a", "a,,b", "a:x=1,"}) {
    EXPECT_TRUE(says(thrown_message([&] { parse_spec_list(text); }), {"missing"})) << text;
  }
}

RC_GTEST_PROP(SpecList, IsTheInverseOfJoining, ()) {
  const auto word = rc::gen::nonEmpty(rc::gen::string<std::string>());
  const auto name = rc::gen::map(word, [](std::string text) {
    for (char& c : text) c = static_cast<char>('a' + static_cast<unsigned char>(c) % 26);
    return text;
  });
  std::string list;
  std::vector<std::string> expected;
  const int count = *rc::gen::inRange(1, 6);
  for (int i = 0; i < count; ++i) {
    Spec spec{*name, {}};
    const int parameters = *rc::gen::inRange(0, 4);
    for (int k = 0; k < parameters; ++k)
      spec.parameters.emplace_back("key" + std::to_string(k), *name);
    expected.push_back(typed(spec));
    if (i > 0) list += ',';
    list += typed(spec);
  }
  std::vector<std::string> parsed;
  for (const Spec& spec : parse_spec_list(list)) parsed.push_back(typed(spec));
  RC_ASSERT(parsed == expected);
}

TEST(NearestName, IsTheOneWithTheFewestEdits) {
  const std::vector<std::string> names = {"balls", "bumpy", "tetra"};
  EXPECT_EQ(nearest_name("ball", names), "balls");
  EXPECT_EQ(nearest_name("tetera", names), "tetra");
  EXPECT_EQ(nearest_name("dumpy", names), "bumpy");
  EXPECT_EQ(nearest_name("x", {}), "");
}

TEST(NearestName, IsEmptyIfNoneIsClose) {
  const std::vector<std::string> names = {"samet", "samet-net", "sah-bvh"};
  EXPECT_EQ(nearest_name("tinybvh", names), "");
  EXPECT_EQ(did_you_mean("tinybvh", names), "");
  EXPECT_EQ(did_you_mean("smet", names), "did you mean 'samet'? ");
}

TEST(NearestName, IsTheEquivalentOfAForeignName) {
  const std::vector<std::string> structures = {"exhaustive", "samet",   "samet-net", "voxel-grid",
                                               "beam",       "sah-bvh", "tile-beam"};
  EXPECT_EQ(nearest_name("bvh", structures), "sah-bvh");
  EXPECT_EQ(nearest_name("octree", structures), "samet");
  EXPECT_EQ(nearest_name("grid", structures), "voxel-grid");
  EXPECT_EQ(nearest_name("brute-force", structures), "exhaustive");
  EXPECT_EQ(nearest_name("net", structures), "samet-net");
  const std::vector<std::string> parameters = {"max_level", "max_objects", "root"};
  EXPECT_EQ(nearest_name("level", parameters), "max_level");
  EXPECT_EQ(nearest_name("depth", parameters), "max_level");
  const std::vector<std::string> options = {"--resolution", "--samples", "--json"};
  EXPECT_EQ(nearest_name("--size", options), "--resolution");
}

// For some users `picture` is a command, for others a kind of rays.
TEST(NearestName, IsTheMeaningAmongTheNames) {
  EXPECT_EQ(nearest_name("picture", std::vector<std::string>{"render", "run"}), "render");
  EXPECT_EQ(nearest_name("picture", std::vector<std::string>{"primary", "whitted"}), "whitted");
}

// `max` is part of two names, so neither is suggested.
TEST(NearestName, IsEmptyIfSeveralNamesContainTheWord) {
  EXPECT_EQ(nearest_name("max", std::vector<std::string>{"max_level", "max_objects"}), "");
}

}  // namespace
}  // namespace beambench::scenes
