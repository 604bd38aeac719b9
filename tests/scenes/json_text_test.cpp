#include "scenes/base/json_text.hpp"

#include <string>

#include <gtest/gtest.h>

#include "tests/scenes/thrown_message.hpp"
#include "tests/temporary_folder.hpp"

namespace beambench {
namespace {

using nlohmann::json;
using scenes::says;
using scenes::thrown_message;

std::string refusal(const std::string& text) {
  return thrown_message([&] { parse_json<json>(text, "a.json"); });
}

std::string nested(std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); }

TEST(Json, IsReadVerbatim) {
  EXPECT_EQ(parse_json<json>(R"({"b": [1, 2.5, null, "x"], "a": true})", "a.json"),
            json({{"a", true}, {"b", {1, 2.5, nullptr, "x"}}}));
  const auto ordered = parse_json<nlohmann::ordered_json>(R"({"b": 1, "a": 2})", "a.json");
  EXPECT_EQ(ordered.begin().key(), "b");
}

TEST(Json, RefusesInvalidJsonByLineAndColumn) {
  EXPECT_TRUE(says(refusal("{\n  \"a\": smet}"), {"a.json:2:8", "not JSON"}));
  EXPECT_TRUE(says(refusal("{\n\"a\": 1,\n}"), {"a.json:3:1", "a comma before this '}'"}));
  EXPECT_TRUE(says(refusal("[\"\xFF\"]"), {"a.json:1:", "UTF-8", "\\xff"}));
  EXPECT_TRUE(says(refusal(""), {"a.json:1:1", "not JSON"}));
}

TEST(Json, RefusesNumbersBeyondADouble) {
  EXPECT_TRUE(says(refusal("{\n\"budget_seconds\": 1e400}"), {"a.json:2:", "1e400", "too large"}));
}

TEST(Json, RefusesDeepNesting) {
  EXPECT_EQ(refusal(nested(64)), "(nothing thrown)");
  EXPECT_TRUE(says(refusal(nested(65)), {"a.json", "64 levels"}));
  EXPECT_TRUE(says(refusal(nested(400'000)), {"64 levels"}));
  EXPECT_TRUE(says(refusal(std::string(400'000, '[')), {"64 levels"}));
  std::string objects;
  for (int i = 0; i < 100'000; ++i) objects += R"({"a":)";
  EXPECT_TRUE(says(refusal(objects), {"64 levels"}));
}

TEST(Json, RefusesDuplicateKeys) {
  EXPECT_TRUE(says(refusal(R"({"a": {"b": 1, "b": 2}})"), {"a.json", "\"b\"", "twice"}));
  EXPECT_EQ(refusal(R"([{"b": 1}, {"b": 2}])"), "(nothing thrown)");
}

TEST(Json, FilesMayBeginWithAByteOrderMark) {
  const TemporaryFolder folder;
  EXPECT_EQ(read_json_file<json>(folder.write("a.json", "\xEF\xBB\xBF[1]")), json({1}));
}

TEST(Json, IsAlwaysWrittenAsUtf8) {
  EXPECT_EQ(json_text(json("C\xE1mara"), -1), "\"C\xEF\xBF\xBDmara\"");
  EXPECT_EQ(json_text(json({{"a", 1}})), "{\n  \"a\": 1\n}");
  EXPECT_EQ(json_text(json("esc\x1B"), -1), "\"esc\\u001b\"");
}

TEST(Json, ValuesOfAnotherTypeAreRefusedByFile) {
  const json document = {{"row", {1}}};
  EXPECT_TRUE(says(thrown_message([&] {
                     read_as_written("cells/0.json", "remove it", [&] {
                       return document.at("row").at("verdict").get<std::string>();
                     });
                   }),
                   {"cells/0.json", "not as it was written", "remove it"}));
}

}  // namespace
}  // namespace beambench
