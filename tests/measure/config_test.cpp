// The configuration of a sweep: parsing, planning, and the places of errors.

#include "harness/measure/config.hpp"

#include <chrono>
#include <initializer_list>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/measure/contender.hpp"
#include "harness/measure/google_benchmark.hpp"
#include "harness/measure/measurement.hpp"
#include "harness/measure/plan.hpp"
#include "tests/scenes/thrown_message.hpp"
#include "tests/temporary_folder.hpp"

namespace beambench::measure {
namespace {

using nlohmann::json;

/// Returns a valid sweep, in which each test changes one thing.
json fine() {
  return json::parse(R"({
    "name": "test",
    "scenes": ["tetra:n=1", {"scene": "balls:n=0", "cameras": ["default"]}],
    "structures": ["null", {"structure": "samet", "parameters": {"max_level": [3, 4]}}],
    "resolutions": ["8x4", "4x4"],
    "samples": [1, 4],
    "rays": ["primary"],
    "precision": 0.1,
    "repetitions": {"minimum": 2, "maximum": 3},
    "budget_seconds": 1
  })");
}

class Config : public testing::Test {
 protected:
  SweepConfig read(const json& document) { return read_text(document.dump()); }
  SweepConfig read_text(const std::string& text) {
    return read_sweep(folder_.write("sweep.json", text), accel::registry());
  }
  std::string refusal(const json& document) {
    return scenes::thrown_message([&] { read(document); });
  }

  TemporaryFolder folder_;
};

/// One wrong value: its place in the sweep, and the expected message.
struct Wrong {
  const char* pointer;
  json value;
  std::vector<const char*> words;
};

class WrongConfig : public Config, public testing::WithParamInterface<Wrong> {};

TEST_P(WrongConfig, IsRefusedAtItsPlace) {
  json document = fine();
  document[json::json_pointer(GetParam().pointer)] = GetParam().value;
  const std::string message = refusal(document);
  EXPECT_TRUE(scenes::says(message, {"sweep.json: "}));
  for (const char* word : GetParam().words) EXPECT_TRUE(scenes::says(message, {word}));
}

INSTANTIATE_TEST_SUITE_P(
    , WrongConfig,
    testing::Values(
        Wrong{"/structurs", json::array(), {"/structurs: unknown key", "'structures'"}},
        Wrong{"/name", "a/b", {"/name: expected", "letters"}},
        Wrong{"/name", 3, {"/name: expected a string, found 3"}},
        Wrong{"/scenes", json::array(), {"/scenes: expected a list with at least one", "empty"}},
        Wrong{"/scenes", "tetra", {"/scenes: expected a list", "\"tetra\""}},
        Wrong{"/scenes/1", {{"cameras", {"x"}}}, {"/scenes/1: the key 'scene' is missing"}},
        Wrong{"/scenes/1/camera", "x", {"/scenes/1/camera: unknown key", "cameras"}},
        Wrong{"/structures/0", "sammet", {"/structures/0: ", "sammet", "samet"}},
        Wrong{"/structures/0", "samet:max_level=99", {"/structures/0: ", "max_level", "99"}},
        Wrong{"/structures/1/structure", "sammet", {"/structures/1/structure: ", "samet"}},
        Wrong{
            "/structures/1/parameters/max_level", 0, {"/structures/1/parameters/max_level: ", "0"}},
        Wrong{"/structures/1/parameters/max_level/1",
              6.5,
              {"/structures/1/parameters/max_level/1: ", "6.5"}},
        Wrong{"/structures/1/parameters/max_level",
              json::array(),
              {"/structures/1/parameters/max_level: expected a list"}},
        Wrong{"/structures/1/parameters/max_lvl", 3, {"/parameters/max_lvl: ", "max_level"}},
        Wrong{"/structures/1/parameters/max_level",
              nullptr,
              {"/parameters/max_level: expected a number", "null"}},
        Wrong{"/resolutions/1", "640", {"/resolutions/1: ", "640", "WIDTHxHEIGHT"}},
        Wrong{"/resolutions/1", "0x5", {"/resolutions/1: ", "0x5"}},
        Wrong{"/resolutions/1", "99999x5", {"/resolutions/1: ", "16384"}},
        Wrong{"/samples/1", 3, {"/samples/1: ", "3"}},
        Wrong{"/samples/1", 1.5, {"/samples/1: expected a whole number", "1.5"}},
        Wrong{"/samples", {1, 1000000000}, {"/samples/1: expected a whole number from 1 to"}},
        Wrong{"/rays/0", "gamma", {"/rays/0: ", "gamma", "primary"}},
        Wrong{"/threads", 0, {"/threads: expected a whole number from 1", "0"}},
        Wrong{"/threads", {1, 2}, {"/threads: expected a whole number"}},
        Wrong{"/precision", -0.5, {"/precision: expected a number from 0 to 1", "-0.5"}},
        Wrong{"/precision", "good", {"/precision: expected a number"}},
        Wrong{"/precision_of", "mean", {"/precision_of: expected median or minimum", "\"mean\""}},
        Wrong{"/repetitions/minimum", 0, {"/repetitions/minimum: expected a whole number from 1"}},
        Wrong{"/repetitions/second_traces",
              -1,
              {"/repetitions/second_traces: expected a whole number from 0"}},
        Wrong{"/repetitions/maximum", 1, {"/repetitions/maximum: expected a whole number from 2"}},
        Wrong{"/repetitions/maximum",
              18446744073709551615ULL,
              {"/repetitions/maximum: expected", "18446744073709551615"}},
        Wrong{"/budget_seconds", -1, {"/budget_seconds: expected a number"}},
        Wrong{"/exclude", {json::object()}, {"/exclude/0: ", "at least one condition"}},
        Wrong{"/exclude", {{{"structure", "samt"}}}, {"/exclude/0/structure: ", "samet"}},
        Wrong{"/exclude", {{{"rays_above", -3}}}, {"/exclude/0/rays_above: expected"}}));

TEST_F(Config, FramesAreSeparateScenes) {
  json document = fine();
  document["scenes"] = {{{"scene", "waving-sheet:triangles=200"}, {"frames", {0, 7}}}};
  document["structures"] = {
      {{"structure", "sah-bvh"}, {"parameters", {{"update", {false, true}}}}}};
  const SweepConfig config = read(document);
  ASSERT_EQ(config.scenes.size(), 2U);
  EXPECT_EQ(config.scenes[1].spec, "waving-sheet:triangles=200@7");
  const Plan plan = make_plan(config);
  ASSERT_FALSE(plan.groups.empty());
  EXPECT_EQ(plan.groups.back().scene->frame, 7U);
  EXPECT_EQ(plan.groups.back().cells.size(), 2U);
  EXPECT_EQ(shown_scene(plan.groups.back().scene->name), "waving-sheet:triangles=200@7");
}

TEST_F(Config, MissingKeysAreNamed) {
  for (const char* key : {"name", "scenes", "structures", "resolutions", "budget_seconds"}) {
    json document = fine();
    document.erase(key);
    EXPECT_TRUE(scenes::says(refusal(document), {"sweep.json: the key", key, "missing"}));
  }
}

TEST_F(Config, MalformedJsonNamesLineAndColumn) {
  const auto refusal_of = [&](const std::string& text) {
    return scenes::thrown_message([&] { read_text(text); });
  };
  EXPECT_TRUE(scenes::says(refusal_of("{\n  \"name\": test\n}"), {"sweep.json:2:12: not JSON"}));
  EXPECT_TRUE(scenes::says(refusal_of(""), {"sweep.json:1:1: not JSON"}));
  EXPECT_TRUE(scenes::says(refusal_of("{\"name\": \"a\""), {"sweep.json:1:", "not JSON"}));
  EXPECT_TRUE(
      scenes::says(refusal_of("[]"), {"sweep.json: expected an object, found an empty list"}));
  EXPECT_TRUE(
      scenes::says(refusal_of("{\"name\": \"a\", \"name\": \"b\"}"), {"\"name\"", "twice"}));
}

TEST_F(Config, AMissingFileIsNamed) {
  EXPECT_TRUE(
      scenes::says(scenes::thrown_message([&] { read_sweep("no/such.json", accel::registry()); }),
                   {"no/such.json: cannot be read: No such file"}));
  EXPECT_TRUE(
      scenes::says(scenes::thrown_message([&] { read_sweep(folder_.path(), accel::registry()); }),
                   {folder_.path().string() + ": cannot be read: it is a folder"}));
}

TEST_F(Config, TooManyCombinationsAreRefused) {
  json document = fine();
  json values = json::array();
  for (int i = 0; i < 200; ++i) values.push_back(i);
  document["structures"][1]["parameters"] = {{"max_objects", values}, {"max_references", values}};
  document["structures"][1]["parameters"]["max_references"][0] = 200;
  EXPECT_TRUE(scenes::says(refusal(document), {"sweep.json: its lists multiply to 320008 cells",
                                               "2 cameras of scenes x 40001 structures",
                                               "more than 100000", "shorten them"}));
}

/// This sweep, found in a review, took 9.9 GB and half a minute before cells were counted first.
TEST_F(Config, TooManyCellsAreRefusedBeforeAnyIsMade) {
  json document = fine();
  document["structures"] = json::array();
  for (int i = 0; i < 10'000; ++i) {
    document["structures"].push_back(fmt::format("samet:max_references={}", 1000 + i));
  }
  document["resolutions"] = json::array();
  for (int i = 1; i <= 1'000; ++i) document["resolutions"].push_back(fmt::format("{}x1", i));
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_TRUE(scenes::says(refusal(document), {"multiply to 40000000 cells", "10000 structures",
                                               "1000 resolutions", "2 samples"}));
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  EXPECT_LT(seconds.count(), 2.0) << "a debug build spends most of this time reading the JSON";
}

TEST_F(Config, AllStructuresAreCountedOneByOne) {
  json document = fine();
  document["structures"] = json::array();
  for (int i = 0; i < 10'000; ++i) document["structures"].push_back("all");
  document["samples"] = {1};
  EXPECT_TRUE(scenes::says(refusal(document), {"its lists multiply to"}));
}

TEST_F(Config, TheMaximumNumberOfCellsIsRead) {
  json document = fine();
  document["scenes"] = {"tetra:n=1"};
  document["samples"] = {1};
  document["structures"] = {"null"};
  document["resolutions"] = json::array();
  for (int i = 0; i < 100'000; ++i) document["resolutions"].push_back("8x4");
  EXPECT_EQ(read(document).resolutions.size(), 100'000U);
  document["resolutions"].push_back("8x4");
  EXPECT_TRUE(scenes::says(refusal(document), {"100001 cells"}));
}

TEST_F(Config, CountingCellsLeavesMistakesToTheReader) {
  EXPECT_TRUE(scenes::says(scenes::thrown_message([&] { read_text(R"("text")"); }),
                           {"sweep.json: expected an object"}));
  for (const char* key : {"scenes", "structures", "resolutions", "samples", "rays"}) {
    for (const json& value :
         {json(3), json(nullptr), json::object(), json(json::array({3, json::array()}))}) {
      json document = fine();
      document[key] = value;
      EXPECT_TRUE(scenes::says(refusal(document), {std::string("/") + key})) << document;
    }
  }
}

TEST_F(Config, PicturesRefuseSeveralThreads) {
  EXPECT_EQ(read(fine()).threads, 1);
  json document = fine();
  document["threads"] = 3;
  EXPECT_EQ(read(document).threads, 3);
  document["rays"] = {"primary", "shadow"};
  EXPECT_EQ(read(document).threads, 3);
  document["rays"] = {"primary", "whitted"};
  EXPECT_TRUE(scenes::says(refusal(document), {"/threads: pictures are drawn on one thread"}));
  document["threads"] = 1;
  EXPECT_EQ(read(document).threads, 1);
}

TEST_F(Config, ListsOfParametersAreExpanded) {
  json document = fine();
  document["structures"] = json::parse(
      R"([{"structure": "samet", "parameters": {"max_level": [3, 4], "root": ["cube", "box"]}}])");
  const SweepConfig config = read(document);
  std::vector<std::string> labels;
  for (const SweptStructure& one : config.structures) labels.push_back(one.sets.front().label());
  ASSERT_EQ(labels.size(), 4U);
  EXPECT_TRUE(scenes::says(labels[0], {"max_level=3", "root=cube"}));
  EXPECT_TRUE(scenes::says(labels[1], {"max_level=3", "root=box"}));
  EXPECT_TRUE(scenes::says(labels[3], {"max_level=4", "root=box"}));
}

TEST_F(Config, ThePlanIsTheProduct) {
  const Plan plan = make_plan(read(fine()));
  EXPECT_EQ(plan.groups.size(), 2U * 2 * 2);  // scenes, resolutions, samples
  EXPECT_EQ(plan.cell_count(), plan.groups.size() * 3);
  EXPECT_EQ(plan.merged, 0U);
  ASSERT_EQ(scene_facts(plan).size(), 2U);
  EXPECT_EQ(scene_facts(plan)[0].primitives, 4U);
  EXPECT_EQ(plan.groups[0].name(), "tetra:n=1/default/8x4/1/primary");
  std::size_t index = 0;
  for (const CellGroup& group : plan.groups) {
    for (const PlannedCell& cell : group.cells) EXPECT_EQ(cell.index, index++);
  }
}

TEST_F(Config, EachSceneIsLoadedOnce) {
  const Plan plan = make_plan(read(fine()));
  EXPECT_EQ(plan.groups[0].scene.get(), plan.groups[3].scene.get());
}

TEST_F(Config, CellsRequestedTwiceArePlannedOnce) {
  json document = fine();
  document["scenes"] = {"tetra:n=1", "tetra:n=1"};
  document["structures"] = {"null", "null"};
  const Plan plan = make_plan(read(document));
  EXPECT_EQ(plan.cell_count(), 4U);
  EXPECT_EQ(plan.merged, 12U);
}

TEST_F(Config, ExclusionsLeaveOutCellsThatMeetAllTheirConditions) {
  json document = fine();
  document["exclude"] = json::parse(
      R"([{"structure": "samet", "primitives_above": 3, "rays_above": 100}, {"scene": "balls:n=0"}])");
  const Plan plan = make_plan(read(document));
  for (const CellGroup& group : plan.groups) {
    EXPECT_EQ(group.scene->name, "tetra:n=1");
    const bool large = group.resolution.width * group.resolution.height * group.samples > 100;
    EXPECT_EQ(group.cells.size(), large ? 1U : 3U) << group.name();
  }
}

TEST_F(Config, OneOrderOfAListCanBeLeftOut) {
  json document = fine();
  document["rays"] = {"diffuse", "diffuse:order=sorted"};
  document["exclude"] = json::parse(R"([{"structure": "samet", "order": "sorted"}])");
  std::set<std::pair<std::string, bool>> planned;
  const Plan plan = make_plan(read(document));
  for (const CellGroup& group : plan.groups) {
    for (const PlannedCell& cell : group.cells) {
      planned.emplace(cell.structure.info().name, cell.rays.is_sorted);
    }
  }
  EXPECT_TRUE(planned.contains({"samet", false}));
  EXPECT_FALSE(planned.contains({"samet", true}));
  EXPECT_TRUE(planned.contains({"null", true}));
}

TEST_F(Config, APlanWithoutCellsIsRefused) {
  json document = fine();
  document["exclude"] = json::parse(R"([{"rays_above": 0}])");
  EXPECT_TRUE(
      scenes::says(scenes::thrown_message([&] { make_plan(read(document)); }), {"exclude"}));
}

TEST_F(Config, InvalidScenesAreRefusedAtTheirPlace) {
  json document = fine();
  document["scenes"][0] = "tetrra:n=1";
  EXPECT_TRUE(scenes::says(scenes::thrown_message([&] { make_plan(read(document)); }),
                           {"/scenes/0: ", "tetra"}));
  document["scenes"][0] = "no/such.nff";
  EXPECT_TRUE(scenes::says(scenes::thrown_message([&] { make_plan(read(document)); }),
                           {"/scenes/0: ", "no/such.nff"}));
  document["scenes"][0] = {{"scene", "tetra:n=1"}, {"cameras", {"left"}}};
  EXPECT_TRUE(scenes::says(scenes::thrown_message([&] { make_plan(read(document)); }),
                           {"/scenes/0: ", "'left'", "default"}));
}

TEST(BenchmarkFlags, AreClassifiedByTheirMeaningHere) {
  const BenchmarkFlags flags =
      parse_benchmark_flags({"--benchmark_filter=samet", "--benchmark_repetitions=7",
                             "--benchmark_min_time=0.1", "--benchmark_list_tests"});
  EXPECT_EQ(flags.passed_on, std::vector<std::string>{"--benchmark_filter=samet"});
  EXPECT_EQ(flags.repetitions, 7);
  EXPECT_TRUE(flags.list);
  ASSERT_EQ(flags.notes.size(), 1U);
  EXPECT_TRUE(scenes::says(flags.notes[0], {"--benchmark_min_time has no effect"}));
}

TEST(BenchmarkFlags, UnknownOnesAreRefused) {
  EXPECT_TRUE(
      scenes::says(scenes::thrown_message([] { parse_benchmark_flags({"--benchmark_fliter=x"}); }),
                   {"--benchmark_fliter", "--benchmark_filter"}));
  EXPECT_TRUE(scenes::says(
      scenes::thrown_message([] { parse_benchmark_flags({"--benchmark_repetitions=no"}); }),
      {"'no'", "whole number"}));
}

TEST(BenchmarkFlags, TheFilterFollowsGoogleBenchmarksRules) {
  const std::vector<std::string> names{"a/samet:max_level=5", "a/samet:max_level=6", "b/embree"};
  const auto select = [&](const std::string& filter) {
    return GoogleBenchmark(parse_benchmark_flags({"--benchmark_filter=" + filter})).select(names);
  };
  EXPECT_EQ(select("samet").size(), 2U);
  EXPECT_EQ(select("-samet"), std::set<std::string>{"b/embree"});
  EXPECT_EQ(select("^a.*6$"), std::set<std::string>{"a/samet:max_level=6"});
  EXPECT_EQ(select("").size(), 3U);
  EXPECT_TRUE(
      scenes::says(scenes::thrown_message([&] { select("bvh"); }), {"'bvh'", "none of the 3"}));
}

TEST(ClockRate, IsThatOfTheProcessor) {
  const double before = clock_ghz();
  EXPECT_GT(before, 0.2);
  EXPECT_LT(before, 20.0);
}

}  // namespace
}  // namespace beambench::measure
