// The names of contenders and views.

#include "harness/analysis/names.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace beambench::analysis {
namespace {

NamedCell cell(const std::string& structure, const std::string& parameters) {
  return {"a", "default", structure, parameters, 1, "primary", "0123456789abcdef", 1};
}

std::vector<std::string> contenders(const std::vector<NamedCell>& cells) {
  std::vector<std::string> found;
  for (const Names& names : name_cells(cells)) found.push_back(names.contender);
  return found;
}

TEST(Names, AContenderShowsOnlyTheParametersThatVary) {
  EXPECT_EQ(contenders({cell("samet", "max_level=5,max_objects=0"),
                        cell("samet", "max_level=6,max_objects=0"), cell("embree", "mode=single"),
                        cell("null", "")}),
            (std::vector<std::string>{"samet max_level=5", "samet max_level=6", "embree", "null"}));
}

TEST(Names, AParameterThatOnlySomeVariantsHaveIsShown) {
  EXPECT_EQ(contenders({cell("embree", "mode=single"), cell("embree", "mode=packet,width=8")}),
            (std::vector<std::string>{"embree mode=single", "embree mode=packet width=8"}));
}

TEST(Names, AFlagThatChangesHitsIsShownWhereEveryVariantHasIt) {
  EXPECT_EQ(contenders({cell("embree", "mode=single,robust=false"),
                        cell("embree", "mode=packet16,robust=false"),
                        cell("tile-beam", "max_leaf=32,backface_culling=true")}),
            (std::vector<std::string>{"embree mode=single robust=false",
                                      "embree mode=packet16 robust=false",
                                      "tile-beam backface_culling=true"}));
  EXPECT_EQ(
      contenders({cell("embree", "robust=true"), cell("tile-beam", "backface_culling=false")}),
      (std::vector<std::string>{"embree", "tile-beam"}));
}

/// Returns the views of two cells that differ in one member.
template <class Value>
std::vector<std::string> views(Value NamedCell::*member, const Value& first, const Value& second) {
  std::vector<NamedCell> cells{cell("samet", ""), cell("samet", "")};
  cells[0].*member = first;
  cells[1].*member = second;
  std::vector<std::string> found;
  for (const Names& names : name_cells(cells)) found.push_back(names.view);
  return found;
}

TEST(Names, AViewStatesWhatVaries) {
  using List = std::vector<std::string>;
  EXPECT_EQ(views<std::string>(&NamedCell::scene, "a", "b"), (List{"a", "b"}));
  EXPECT_EQ(views<std::string>(&NamedCell::camera, "front", "back"),
            (List{"a, camera front", "a, camera back"}));
  EXPECT_EQ(views(&NamedCell::samples, 1, 5), (List{"a, 1 samples", "a, 5 samples"}));
  EXPECT_EQ(views<std::string>(&NamedCell::ray_kind, "primary", "shadow"),
            (List{"a, primary rays", "a, shadow rays"}));
  EXPECT_EQ(views<std::string>(&NamedCell::machine_id, "0123456789abcdef", "fedcba9876543210"),
            (List{"a, machine 01234567", "a, machine fedcba98"}));
}

TEST(Names, ATunedContenderIsNamedByItsNumberOfParameterSets) {
  NamedCell best = cell("embree", "mode=stream");
  best.parameter_sets = 8;
  EXPECT_EQ(contenders({best, cell("embree", "mode=single")}),
            (std::vector<std::string>{"embree (best of 8)", "embree"}));
}

TEST(Names, TheOrderOfRaysBelongsToTheContenderNotTheView) {
  std::vector<NamedCell> cells{cell("samet", ""), cell("samet", "")};
  cells[0].ray_kind = "diffuse:seed=7";
  cells[1].ray_kind = "diffuse:order=sorted,seed=7";
  EXPECT_EQ(contenders(cells), (std::vector<std::string>{"samet", "samet, sorted rays"}));
  EXPECT_EQ(name_cells(cells)[0].view, name_cells(cells)[1].view);
}

}  // namespace
}  // namespace beambench::analysis
