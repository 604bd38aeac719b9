#include "scenes/base/parameters.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/scenes/thrown_message.hpp"

namespace beambench::scenes {
namespace {

using Given = std::vector<std::pair<std::string, std::string>>;

const std::vector<ParameterInfo> kInfos = {
    integer_parameter("level", 6, 1, 20, "levels"),
    real_parameter("pad", 0.5, 0.0, 2.0, "padding"),
    flag_parameter("net", false, "whether there is a net"),
    choice_parameter("root", "cube", {"cube", "box"}, "shape of the root"),
};

Parameters with(const Given& given) { return Parameters("tree", kInfos, given); }

TEST(Parameters, DefaultsApplyIfNothingIsGiven) {
  const Parameters parameters = with({});
  EXPECT_EQ(parameters.integer("level"), 6);
  EXPECT_EQ(parameters.real("pad"), 0.5);
  EXPECT_FALSE(parameters.flag("net"));
  EXPECT_EQ(parameters.choice("root"), "cube");
  EXPECT_EQ(parameters.label(), "tree:level=6,pad=0.5,net=false,root=cube");
}

TEST(Parameters, GivenValuesReplaceDefaults) {
  const Parameters parameters =
      with({{"root", "box"}, {"net", "on"}, {"pad", "1e-3"}, {"level", "20"}});
  EXPECT_EQ(parameters.integer("level"), 20);
  EXPECT_EQ(parameters.real("pad"), 0.001);
  EXPECT_TRUE(parameters.flag("net"));
  EXPECT_EQ(parameters.choice("root"), "box");
}

TEST(Parameters, EqualValuesPrintEqually) {
  EXPECT_EQ(with({{"pad", "1.50"}, {"level", "007"}, {"net", "yes"}}).canonical(),
            with({{"net", "1"}, {"level", "7"}, {"pad", "15e-1"}}).canonical());
  EXPECT_EQ(with({{"pad", "1.50"}}).values()[1],
            (std::pair<std::string, std::string>("pad", "1.5")));
}

TEST(Parameters, CellsAreOneNumberOrThreeOrAutomatic) {
  const std::vector<ParameterInfo> infos = {cells_parameter("cells", "auto", 64, "cells per axis")};
  const auto given = [&](const char* text) {
    return Parameters("grid", infos, Given{{"cells", text}});
  };
  using Cells = std::array<std::int32_t, 3>;
  EXPECT_EQ(Parameters("grid", infos, Given{}).cells("cells"), std::nullopt);
  EXPECT_EQ(given("auto").label(), "grid:cells=auto");
  EXPECT_EQ(given("32").cells("cells"), (Cells{32, 32, 32}));
  EXPECT_EQ(given("64x1x8").cells("cells"), (Cells{64, 1, 8}));
  EXPECT_EQ(given("64x1x8").label(), "grid:cells=64x1x8");
  EXPECT_EQ(given("08x8x8").label(), given("8").label()) << "equal values print equally";
  for (const char* text : {"0", "65", "-3", "8x8", "8x8x8x8", "8x8x", "x8", "8x65x8", "8 x8x8", "",
                           "8.5", "automatic", "8X8X8"}) {
    EXPECT_TRUE(says(thrown_message([&] { given(text); }),
                     {"grid", "cells", "auto, a number of cells from 1 to 64, or three"}))
        << text;
  }
}

TEST(Parameters, IntegersMayBeAutomatic) {
  const std::vector<ParameterInfo> infos{integer_or_auto_parameter("level", 6, 1, 16, "a level")};
  EXPECT_EQ(Parameters("tree", infos, {}).integer_or_auto("level"), 6);
  const std::vector<std::pair<std::string, std::string>> automatic{{"level", "auto"}};
  const Parameters chosen("tree", infos, automatic);
  EXPECT_EQ(chosen.integer_or_auto("level"), std::nullopt);
  EXPECT_EQ(chosen.label(), "tree:level=auto");
  for (const char* wrong : {"17", "0", "automatic", "", "6.5"}) {
    const std::vector<std::pair<std::string, std::string>> given{{"level", wrong}};
    try {
      Parameters("tree", infos, given);
      FAIL() << wrong;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("auto, or an integer from 1 to 16"),
                std::string::npos)
          << error.what();
    }
  }
}

TEST(Parameters, LabelIsTheBareOwnerWithoutParameters) {
  EXPECT_EQ(Parameters("null", {}, {}).label(), "null");
}

TEST(Parameters, LabelCanBeParsedBack) {
  const Parameters parameters = with({{"level", "3"}, {"root", "box"}});
  const Spec spec = parse_spec(parameters.label());
  EXPECT_EQ(Parameters(spec.name, kInfos, spec.parameters).label(), parameters.label());
}

TEST(Parameters, OutOfRangeNamesOwnerValueAndRange) {
  EXPECT_TRUE(says(thrown_message([] {
                     with({{"level", "21"}});
                   }),
                   {"tree", "level", "'21'", "an integer from 1 to 20"}));
  EXPECT_TRUE(says(thrown_message([] { with({{"level", "0"}}); }), {"from 1 to 20"}));
  EXPECT_TRUE(says(thrown_message([] { with({{"pad", "2.001"}}); }), {"a number from 0 to 2"}));
  EXPECT_TRUE(says(thrown_message([] { with({{"pad", "nan"}}); }), {"a number from 0 to 2"}));
}

TEST(Parameters, WrongTypeIsRefused) {
  for (const char* text : {"6.5", "six", "", "6x", " 6", "99999999999999999999"}) {
    EXPECT_TRUE(says(thrown_message([&] { with({{"level", text}}); }), {"an integer"})) << text;
  }
  EXPECT_TRUE(says(thrown_message([] { with({{"pad", "1,5"}}); }), {"a number"}));
  EXPECT_TRUE(says(thrown_message([] { with({{"net", "maybe"}}); }), {"true or false"}));
  EXPECT_TRUE(says(thrown_message([] { with({{"root", "ball"}}); }), {"one of cube, box"}));
}

TEST(Parameters, UnknownNameListsTheValidOnes) {
  EXPECT_TRUE(says(thrown_message([] {
                     with({{"levels", "3"}});
                   }),
                   {"'levels'", "level, pad, net, root"}));
  EXPECT_TRUE(says(thrown_message([] {
                     Parameters("null", {}, Given{{"n", "3"}});
                   }),
                   {"null takes none"}));
}

TEST(Parameters, UnreadParametersAreAnErrorOfTheOwner) {
  const Parameters parameters = with({{"level", "3"}});
  EXPECT_THROW(parameters.require_given_were_read(), std::logic_error);
  parameters.integer("level");
  EXPECT_NO_THROW(parameters.require_given_were_read());
}

TEST(Parameters, ReadingUndeclaredParametersIsAnErrorOfTheOwner) {
  const Parameters parameters = with({});
  EXPECT_THROW(parameters.integer("depth"), std::logic_error);
  EXPECT_THROW(parameters.real("level"), std::logic_error);
}

TEST(Parameters, InvalidDefaultIsAnErrorOfTheOwner) {
  const std::vector<ParameterInfo> infos = {integer_parameter("n", 9, 0, 8, "too large")};
  EXPECT_THROW(Parameters("tree", infos, {}), std::logic_error);
  EXPECT_THROW(integer_parameter("n", 0, 0, std::int64_t{1} << 60, "range beyond 2^53"),
               std::logic_error);
}

}  // namespace
}  // namespace beambench::scenes
