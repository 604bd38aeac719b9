// The record of a run: statistics, CSV, fingerprints, rows.

#include <algorithm>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "harness/bench/record/cell_record.hpp"
#include "harness/bench/record/machine.hpp"
#include "harness/bench/record/manifest.hpp"
#include "harness/bench/record/robust_statistics.hpp"
#include "harness/bench/record/run_folder.hpp"
#include "harness/rays/fingerprint.hpp"
#include "scenes/camera.hpp"
#include "tests/scenes/thrown_message.hpp"
#include "tests/temporary_folder.hpp"

namespace beambench::bench {
namespace {

using Fields = std::vector<std::vector<std::string>>;

/// Reads CSV back by RFC 4180, independently of how it was written.
Fields read_csv(const std::string& text) {
  Fields rows;
  std::vector<std::string> row;
  std::string field;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c != '"') {
        field += c;
      } else if (i + 1 < text.size() && text[i + 1] == '"') {
        field += text[++i];
      } else {
        quoted = false;
      }
    } else if (c == '"') {
      quoted = true;
    } else if (c == ',' || c == '\n') {
      row.push_back(std::exchange(field, {}));
      if (c == '\n') rows.push_back(std::exchange(row, {}));
    } else {
      field += c;
    }
  }
  return rows;
}

TEST(Statistics, MedianIsTheMiddle) {
  EXPECT_EQ(median(std::vector{3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median(std::vector{4.0, 1.0, 2.0, 3.0}), 2.5);
  EXPECT_EQ(median(std::vector{7.0}), 7.0);
}

TEST(Statistics, OneWildRepetitionMovesNothing) {
  const std::vector<double> calm{10.0, 11.0, 12.0, 13.0, 14.0};
  const std::vector<double> disturbed{10.0, 11.0, 12.0, 13.0, 1e6};
  EXPECT_EQ(median(disturbed), median(calm));
  EXPECT_EQ(median_absolute_deviation(disturbed), median_absolute_deviation(calm));
  EXPECT_EQ(minimum(disturbed), 10.0);
}

TEST(Statistics, IntervalHasTheTabulatedRanks) {
  // Ranks of the 95% interval of the median (Conover, table A3): n -> lower rank.
  const std::vector<std::pair<int, int>> table{{6, 1},   {8, 1},   {9, 2},   {11, 2}, {12, 3},
                                               {15, 4},  {17, 5},  {20, 6},  {25, 8}, {30, 10},
                                               {40, 14}, {50, 18}, {100, 40}};
  for (const auto& [n, rank] : table) {
    std::vector<double> samples(static_cast<std::size_t>(n));
    std::iota(samples.begin(), samples.end(), 1.0);
    const auto interval = median_interval(samples);
    ASSERT_TRUE(interval) << n;
    EXPECT_EQ(interval->low, rank) << n;
    EXPECT_EQ(interval->high, n + 1 - rank) << n;
  }
}

TEST(Statistics, FewerThanSixSamplesHaveNoInterval) {
  EXPECT_FALSE(median_interval(std::vector{1.0, 2.0, 3.0, 4.0, 5.0}));
  EXPECT_FALSE(median_interval({}));
}

TEST(Statistics, IntervalCoversTheMedianOfASkewedDistribution) {
  std::mt19937_64 engine(1);
  std::exponential_distribution<double> distribution(1.0);
  const double true_median = std::log(2.0);
  int covered = 0;
  constexpr int kTrials = 4000;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> samples(21);
    std::generate(samples.begin(), samples.end(), [&] { return distribution(engine); });
    const auto interval = median_interval(samples);
    covered += interval->low <= true_median && true_median <= interval->high ? 1 : 0;
  }
  EXPECT_GT(covered, kTrials * 94 / 100);
  EXPECT_LT(covered, kTrials * 99 / 100);  // an interval of everything would say nothing
}

TEST(Statistics, FewerThanNineSamplesHaveNoIntervalOfARepeat) {
  std::vector<double> samples{1, 2, 3, 4, 5, 6, 7, 8};
  EXPECT_FALSE(repeat_interval(samples));
  EXPECT_FALSE(repeat_interval({}));
  samples.push_back(9);
  ASSERT_TRUE(repeat_interval(samples));
  EXPECT_EQ(repeat_interval(samples)->low, 1.0);
  EXPECT_EQ(repeat_interval(samples)->high, 9.0);
}

TEST(Statistics, IntervalOfARepeatCoversTheNextMedian) {
  std::mt19937_64 engine(2);
  std::exponential_distribution<double> distribution(1.0);
  constexpr int kTrials = 4000;
  for (const std::size_t n : {9U, 10U, 21U, 60U}) {
    int covered = 0;
    int covered_by_the_narrower = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      std::vector<double> samples(n);
      std::vector<double> again(n);
      std::generate(samples.begin(), samples.end(), [&] { return distribution(engine); });
      std::generate(again.begin(), again.end(), [&] { return distribution(engine); });
      const auto within = [&](const Interval& interval) {
        return interval.low <= median(again) && median(again) <= interval.high ? 1 : 0;
      };
      covered += within(*repeat_interval(samples));
      covered_by_the_narrower += within(*median_interval(samples));
    }
    EXPECT_GT(covered, kTrials * 94 / 100) << n;
    EXPECT_LT(covered, kTrials * 995 / 1000) << n;
    EXPECT_LT(covered_by_the_narrower, kTrials * 94 / 100) << n;
  }
}

TEST(Statistics, TheSpreadOfTheMinimumReachesToTheFifthOfFifteen) {
  std::vector<double> samples{16, 15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 1};
  EXPECT_EQ(repeat_spread_of_minimum(samples), 5.0)
      << "6 - 1: 2.1% that a further minimum is above";
  samples.resize(9);
  EXPECT_EQ(repeat_spread_of_minimum(samples), 4.0) << "12 - 8: 1.5%";
  EXPECT_EQ(repeat_spread_of_minimum(std::vector<double>{3, 4, 1, 9}), 8.0) << "1 of 70";
  EXPECT_FALSE(repeat_spread_of_minimum(std::vector<double>{1, 2, 3})) << "1 of 20 is too often";
  EXPECT_FALSE(repeat_spread_of_minimum({}));
}

TEST(Statistics, SpreadOfTheMinimumCoversTheNextMinimum) {
  // A machine that is disturbed in six of ten repetitions, by up to 60%; the rest differ by 1%.
  std::mt19937_64 engine(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const auto sample = [&] {
    const double time = 100.0 + uniform(engine);
    return uniform(engine) < 0.6 ? time * (1.0 + 0.6 * uniform(engine)) : time;
  };
  constexpr int kTrials = 4000;
  for (const std::size_t n : {6U, 9U, 15U, 40U}) {
    int covered = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      std::vector<double> samples(n);
      std::vector<double> again(n);
      std::generate(samples.begin(), samples.end(), sample);
      std::generate(again.begin(), again.end(), sample);
      const double change = minimum(again) - minimum(samples);
      covered += std::abs(change) <= *repeat_spread_of_minimum(samples) ? 1 : 0;
    }
    EXPECT_GT(covered, kTrials * 94 / 100) << n;
    EXPECT_LT(covered, kTrials * 995 / 1000) << n;
  }
}

TEST(Csv, QuotesOnlyWhatNeedsIt) {
  EXPECT_EQ(csv_field("tetra"), "tetra");
  EXPECT_EQ(csv_field(""), "");
  EXPECT_EQ(csv_field("max_level=6,max_objects=0"), "\"max_level=6,max_objects=0\"");
  EXPECT_EQ(csv_field("a \"b\""), "\"a \"\"b\"\"\"");
  EXPECT_EQ(csv_field("two\nlines"), "\"two\nlines\"");
}

TEST(Csv, NoTextIsAFormula) {
  EXPECT_EQ(csv_field("=1+1.nff"), "'=1+1.nff");
  EXPECT_EQ(csv_field("=HYPERLINK(\"a\")"), "\"'=HYPERLINK(\"\"a\"\")\"");
  EXPECT_EQ(csv_field("-O3"), "'-O3");
  EXPECT_EQ(csv_field("+x"), "'+x");
  EXPECT_EQ(csv_field("@x"), "'@x");
  EXPECT_EQ(csv_field("\tx"), "'\tx");
  EXPECT_EQ(csv_field("\rx"), "\"'\rx\"");
  EXPECT_EQ(csv_field("'x"), "''x") << "an apostrophe that readers drop is never the text's own";
  EXPECT_EQ(csv_table(std::vector{Row{{"=a", -1.5}, {"b", -2}, {"c", "-2"}}}),
            "'=a,b,c\n-1.5,-2,'-2\n");
}

RC_GTEST_PROP(Csv, TextsComeBackAsTheyWere, (const std::vector<std::string>& texts)) {
  Row row = Row::object();
  row["first"] = "x";
  std::vector<std::string> expected{"x"};
  for (std::size_t i = 0; i < texts.size(); ++i) {
    row["column" + std::to_string(i)] = texts[i];
    expected.push_back(texts[i]);
  }
  Fields read = read_csv(csv_table(std::vector{row}));
  RC_ASSERT(read.size() == 2U);
  for (std::string& text : read[1]) {
    if (text.starts_with('\'')) text.erase(0, 1);
  }
  RC_ASSERT(read[1] == expected);
}

RC_GTEST_PROP(Csv, NumbersComeBackAsTheyWere, (double number)) {
  const Fields read = read_csv(csv_table(std::vector{Row{{"number", number}}}));
  RC_ASSERT(std::stod(read[1][0]) == number);
}

TEST(Csv, ColumnsAreTheUnionInOrder) {
  const std::vector<Row> rows{{{"a", 1}, {"z", true}}, {{"a", 2}, {"b", 0.5}, {"z", nullptr}}};
  EXPECT_EQ(csv_table(rows), "a,b,z\n1,,true\n2,0.5,\n");
}

CellRecord some_cell() {
  CellRecord cell{};
  cell.id = {"tetra:n=2", "default", "samet", "max_level=6", {32, 20}, 1, "primary"};
  cell.rays = {1, 2, 0, 16, 640};
  cell.rays.hit_share = 0.5;
  cell.rays.coherence = 0.9;
  cell.verdict = verify::Verdict::kOk;
  cell.statistics.emplace();
  cell.statistics->nodes = 9;
  cell.harness = {QueryPath::kImageSingle, 2.5};
  cell.work.counters = {{"traversal_steps", 1280}, {"clips", 64}};
  cell.allocated_bytes = 4096;
  cell.stop_reason = StopReason::kPrecision;
  cell.diff = verify::DiffReport{};
  for (int round = 0; round < 7; ++round) {
    cell.repetitions.push_back({round, 0, 1.0 + round, 10.0, 1.0, 9.0, {}, {}});
    cell.repetitions.back().trace_counts = {1000U + static_cast<unsigned>(round), 500,
                                            std::nullopt};
  }
  return cell;
}

const RunFacts kRun{"id", "abc", true, "m", "Release", "-O3", "AVX2", 1};

/// The columns that scripts and people rely on, in order.
const char* const kContract =
    "schema_version,run_id,time_utc,commit,dirty,machine_id,build_type,flags,isa,structure_isa,"
    "library_version,library_geometry,threads,"
    "scene,camera,scene_hash,rays_hash,seed,primitives,"
    "structure,parameters,width,height,samples,ray_kind,query,query_path,rays,hit_share,"
    "occluded_share,coherence,"
    "repetitions,stop_reason,"
    "build_ms_median,build_ms_min,build_ms_mad,trace_ms_median,trace_ms_min,trace_ms_mad,"
    "trace_ms_ci_low,trace_ms_ci_high,"
    "trace_warm_ms_median,trace_warm_ms_ci_low,trace_warm_ms_ci_high,"
    "harness_ms,trace_net_ms_median,"
    "total_ms_median,total_ms_min,total_ms_mad,total_ms_ci_low,total_ms_ci_high,"
    "total_ms_min_spread,"
    "clock_ghz_median,total_mcycles_median,total_mcycles_ci_low,total_mcycles_ci_high,"
    "total_mcycles_repeat_low,total_mcycles_repeat_high,"
    "build_cpu_ms_median,trace_cpu_ms_median,mrays_per_s,"
    "build_instructions,build_cycles,build_cache_misses,"
    "trace_instructions,trace_cycles,trace_cache_misses,"
    "memory_bytes,allocated_bytes,nodes,leaves,empty_leaves,references,depth,tree_cost,"
    "sah_nodes,sah_leaves,sah_tests,"
    "traversal_steps_per_ray,leaves_per_ray,empty_leaves_per_ray,box_tests_per_ray,"
    "primitive_tests_per_ray,sphere_tests_per_ray,cone_tests_per_ray,polygon_tests_per_ray,"
    "hits,agree,tie,graze,structure_error,embree_error,verdict\n";

TEST(CellRow, HasTheColumnsOfTheContract) {
  CellRecord cell = some_cell();
  cell.work.counters.erase("clips");
  const std::string table = csv_table(std::vector{to_row(kRun, cell)});
  EXPECT_EQ(table.substr(0, table.find('\n') + 1), kContract);
}

TEST(CellRow, SumsUpTheRepetitions) {
  const Row row = to_row(kRun, some_cell());
  EXPECT_EQ(row.at("schema_version"), kSchemaVersion);
  EXPECT_EQ(row.at("repetitions"), 7);
  EXPECT_EQ(row.at("build_ms_median"), 4.0);
  EXPECT_EQ(row.at("trace_ms_median"), 10.0);
  EXPECT_EQ(row.at("total_ms_median"), 14.0);
  EXPECT_EQ(row.at("trace_ms_ci_low"), 10.0);
  EXPECT_EQ(row.at("trace_ms_ci_high"), 10.0);
  EXPECT_EQ(row.at("total_ms_ci_low"), 11.0);
  EXPECT_EQ(row.at("total_ms_ci_high"), 17.0);
  EXPECT_EQ(row.at("total_ms_min_spread"), 4.0) << "the fifth-lowest of seven";
  EXPECT_EQ(row.at("mrays_per_s"), 0.064);  // 640 rays in 10 ms
  EXPECT_EQ(row.at("traversal_steps_per_ray"), 2.0);
  EXPECT_EQ(row.at("clips_per_ray"), 0.1);
  EXPECT_TRUE(row.at("box_tests_per_ray").is_null());
  EXPECT_EQ(row.at("allocated_bytes"), 4096);
  EXPECT_EQ(row.at("isa"), "AVX2");
  EXPECT_TRUE(row.at("structure_isa").is_null()) << "it does not choose";
}

TEST(CellRow, NamesTheInstructionSetThatTheStructureChose) {
  CellRecord cell = some_cell();
  cell.statistics->instruction_set = "AVX3";
  EXPECT_EQ(to_row(kRun, cell).at("structure_isa"), "AVX3");
}

TEST(CellRow, HardwareCountsAreEmptyWhereTheMachineCountsNone) {
  const CellRecord cell = some_cell();
  const Row row = to_row(kRun, cell);
  EXPECT_EQ(row.at("trace_instructions"), 1003);
  EXPECT_EQ(row.at("trace_cycles"), 500);
  EXPECT_TRUE(row.at("trace_cache_misses").is_null());
  EXPECT_TRUE(row.at("build_instructions").is_null());
  const Row repetition = to_json(kRun, cell).at("repetitions").at(0);
  EXPECT_EQ(repetition.at("trace_instructions"), 1000);
  EXPECT_FALSE(repetition.contains("build_instructions"));
}

TEST(CellRow, TheHarnesssShareIsThatOfItsOwnPath) {
  CellRecord cell = some_cell();
  Row row = to_row(kRun, cell);
  EXPECT_EQ(row.at("query_path"), "image-single");
  EXPECT_EQ(row.at("harness_ms"), 2.5);
  EXPECT_EQ(row.at("trace_net_ms_median"), 7.5);
  cell.harness = {QueryPath::kImageOwn, 0.0};
  row = to_row(kRun, cell);
  EXPECT_EQ(row.at("query_path"), "image-own");
  EXPECT_EQ(row.at("trace_net_ms_median"), 10.0);
  cell.harness = std::nullopt;  // as of a structure that could not be built
  EXPECT_TRUE(to_row(kRun, cell).at("query_path").is_null());
}

TEST(CellRow, TheFirstAndTheSecondTracesHaveAnIntervalEach) {
  CellRecord cell = some_cell();
  for (int i = 0; i < 6; ++i) cell.repetitions[static_cast<std::size_t>(i)].warm_trace_ms = 8.0 + i;
  Row row = to_row(kRun, cell);
  EXPECT_EQ(row.at("trace_ms_median"), 10.0);
  EXPECT_EQ(row.at("trace_warm_ms_median"), 10.5);
  EXPECT_EQ(row.at("trace_warm_ms_ci_low"), 8.0);
  EXPECT_EQ(row.at("trace_warm_ms_ci_high"), 13.0);
  cell.repetitions[0].warm_trace_ms = std::nullopt;
  row = to_row(kRun, cell);
  EXPECT_EQ(row.at("trace_warm_ms_median"), 11.0);
  EXPECT_TRUE(row.at("trace_warm_ms_ci_low").is_null()) << "five have none";
}

TEST(CellRow, NamesALibraryItsVersionAndItsGeometry) {
  CellRecord cell = some_cell();
  EXPECT_TRUE(to_row(kRun, cell).at("library_version").is_null());
  EXPECT_TRUE(to_row(kRun, cell).at("library_geometry").is_null());
  cell.statistics->library_version = "Embree 4.3.3";
  cell.statistics->library_geometry = "triangles+points";
  EXPECT_EQ(to_row(kRun, cell).at("library_version"), "Embree 4.3.3");
  EXPECT_EQ(to_row(kRun, cell).at("library_geometry"), "triangles+points");
  cell.statistics.reset();
  EXPECT_TRUE(to_row(kRun, cell).at("library_version").is_null()) << "it was not built";
}

TEST(CellRow, WithoutTheVerdictOkItKeepsCountersAndLosesTimes) {
  CellRecord cell = some_cell();
  cell.verdict = verify::Verdict::kMismatch;
  const Row row = to_row(kRun, cell);
  for (const auto& [column, value] : row.items()) {
    const bool is_time = column.find("_ms_") != std::string::npos || column == "harness_ms" ||
                         column.find("mcycles") != std::string::npos ||
                         column == "clock_ghz_median" || column == "mrays_per_s" ||
                         column.ends_with("_cycles") || column.ends_with("_instructions") ||
                         column.ends_with("_cache_misses");
    EXPECT_EQ(value.is_null(),
              is_time || column == "leaves_per_ray" || column == "empty_leaves_per_ray" ||
                  column == "box_tests_per_ray" || column == "primitive_tests_per_ray" ||
                  column == "structure_isa" || column == "library_version" ||
                  column == "library_geometry" || column == "occluded_share" ||
                  column == "tree_cost" || column.starts_with("sah_") ||
                  column == "sphere_tests_per_ray" || column == "cone_tests_per_ray" ||
                  column == "polygon_tests_per_ray")
        << column;
  }
  EXPECT_TRUE(to_json(kRun, cell).at("repetitions").empty());
}

TEST(CellId, KeysDifferWhereCellsDo) {
  const CellId id = some_cell().id;
  CellId other = id;
  other.samples = 4;
  EXPECT_NE(id.key(), other.key());
  EXPECT_EQ(id.name(), "tetra:n=2/default/32x20/1/primary/samet:max_level=6");
  EXPECT_EQ(id.key().size(), 16U);
}

TEST(Fingerprint, DiffersWhereRaysOrHitsDo) {
  const scenes::Camera camera;
  scenes::Camera other = camera;
  other.angle = 45.001F;
  EXPECT_EQ(rays::fingerprint(accel::PrimaryRays(camera, 8, 8, 1)),
            rays::fingerprint(accel::PrimaryRays(camera, 8, 8, 1)));
  EXPECT_NE(rays::fingerprint(accel::PrimaryRays(camera, 8, 8, 1)),
            rays::fingerprint(accel::PrimaryRays(other, 8, 8, 1)));
  accel::HitBuffer one(8, 8, 1);
  accel::HitBuffer two(8, 8, 1);
  EXPECT_EQ(rays::fingerprint(one), rays::fingerprint(two));
  two.set(63, accel::Hit{1.0F, 5});
  EXPECT_NE(rays::fingerprint(one), rays::fingerprint(two));
  one.set(63, accel::Hit{1.0F, 6});
  EXPECT_NE(rays::fingerprint(one), rays::fingerprint(two));
}

TEST(RunFolder, RefusesWhatAlreadyHoldsARun) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "run";
  RunFolder::create(path);  // killed before its manifest was written: it has measured nothing
  folder.write("run/.config.123.partial.json", "{");
  RunFolder::create(path).write_json("manifest.json", {});
  EXPECT_FALSE(std::filesystem::exists(path / ".config.123.partial.json"));
  EXPECT_TRUE(scenes::says(scenes::thrown_message([&] { RunFolder::create(path); }),
                           {path.string(), "--resume"}));
}

TEST(RunFolder, RefusesAPlaceWhereNoFolderCanBe) {
  const TemporaryFolder folder;
  const auto file = folder.write("file", "");
  const std::string message = scenes::thrown_message([&] { RunFolder::create(file / "run"); });
  EXPECT_TRUE(scenes::says(message, {"cannot make", "file/run", "-o"}));
}

TEST(RunFolder, RefusesToResumeWhatIsNoRun) {
  const TemporaryFolder folder;
  EXPECT_TRUE(scenes::says(scenes::thrown_message([&] { RunFolder::open(folder.path()); }),
                           {"manifest.json"}));
}

TEST(RunFolder, KeepsCellsInTheOrderOfThePlan) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "run";
  {
    RunFolder run = RunFolder::create(path);
    run.write_json("manifest.json", {});
    for (const std::size_t index : {2U, 0U, 1U}) {
      CellRecord cell = some_cell();
      cell.index = index;
      cell.id.samples = static_cast<int>(index);
      run.add_cell(to_json(kRun, cell));
    }
    folder.write("run/cells/.left-behind.123.partial.json", "{");
  }
  const std::string results = read_text(path / "results.csv");
  RunFolder again = RunFolder::open(path);
  std::vector<nlohmann::ordered_json> cells;
  again.for_each_cell([&](const nlohmann::ordered_json& cell) { cells.push_back(cell); });
  ASSERT_EQ(cells.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(cells[i].at("index"), i);
  again.add_cell(cells[1]);
  EXPECT_EQ(read_text(path / "results.csv"), results);
  EXPECT_FALSE(std::filesystem::exists(path / "cells" / ".left-behind.123.partial.json"));
}

/// Rows are put into results.csv one by one; made from all cells it must be the same.
TEST(RunFolder, PutsRowsWhereTheyBelong) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "run";
  RunFolder run = RunFolder::create(path);
  run.write_json("manifest.json", {});
  const auto add = [&](std::size_t index, const std::string& camera, const char* counter) {
    CellRecord cell = some_cell();
    cell.index = index;
    cell.id.samples = static_cast<int>(index);
    cell.id.camera = camera;
    if (counter != nullptr) cell.work.counters[counter] = 7;
    run.add_cell(to_json(kRun, cell));
    std::vector<Row> rows;
    run.for_each_cell([&](const auto& each) { rows.push_back(each.at("row")); });
    EXPECT_EQ(read_text(path / "results.csv"), csv_table(rows)) << index;
  };
  for (const std::size_t index : {5U, 2U, 9U, 0U, 7U}) add(index, "a,\"b\"\nc", nullptr);
  add(3, "default", "own_counter");
  for (const std::size_t index : {1U, 8U, 4U}) add(index, "default", nullptr);
  std::filesystem::remove(path / "results.csv");
  add(6, "default", nullptr);
  folder.write("run/results.csv", "of somebody else");
  add(10, "default", nullptr);
  std::vector<std::size_t> order;
  run.for_each_cell([&](const auto& cell) { order.push_back(cell.at("index")); });
  EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}));
}

TEST(RunFolder, BelongsToOneAtATime) {
  const TemporaryFolder folder;
  const RunFolder run = RunFolder::create(folder.path() / "run");
  EXPECT_TRUE(
      scenes::says(scenes::thrown_message([&] { RunFolder::create(folder.path() / "run"); }),
                   {"another beambench", "wait until"}));
}

TEST(Machine, DisturbancesAreReportedInPlainWords) {
  Machine machine{};
  machine.governor = "performance";
  machine.turbo = "off";
  EXPECT_TRUE(disturbances(machine).empty());
  machine.governor = "powersave";
  machine.turbo = "on";
  machine.load = 3.0;
  machine.virtual_machine = true;
  machine.huge_pages = "always";
  EXPECT_EQ(disturbances(machine).size(), 5U);
}

TEST(Preflight, ShowsTheMachineAndEachWarning) {
  Manifest manifest;
  manifest.machine.cpu = "Some CPU";
  manifest.measurement.pinned_core = 3;
  manifest.measurement.control_word = 0x9fc0;
  manifest.measurement.noise = 0.125;
  manifest.measurement.hardware_problem = "None.";
  manifest.uncontrolled = {"The clock is wild."};
  const std::vector<std::string> lines = preflight(manifest);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_TRUE(scenes::says(lines[0], {"Some CPU", "core 3", "MXCSR 0x9fc0"}));
  EXPECT_TRUE(scenes::says(lines[1], {"governor unknown", "noise 12.5%", "hardware counters no"}));
  EXPECT_EQ(lines[2], "warning: The clock is wild.");
  EXPECT_TRUE(scenes::says(noise_warning(0.125).value_or(""), {"disturbed", "12%"}));
  EXPECT_FALSE(noise_warning(0.01));
  EXPECT_FALSE(noise_warning(std::nullopt));
}

/// As Linux writes it, of a machine with two cores.
std::string cpuinfo(std::string_view maker, int model, double mhz) {
  const std::string core = fmt::format(
      "vendor_id\t: {}\ncpu family\t: 6\nmodel\t\t: {}\nmodel name\t: Processor\n"
      "stepping\t: 3\ncpu MHz\t\t: {}\nflags\t\t: fpu sse\n",
      maker, model, mhz);
  return fmt::format("processor\t: 0\n{0}\nprocessor\t: 1\n{0}\n", core);
}

TEST(Machine, ProcessorsOfOneNameAreDistinguishedByMakerAndModel) {
  const std::string xeon = processor_identity(cpuinfo("GenuineIntel", 143, 2000));
  EXPECT_EQ(xeon,
            "vendor_id\t: GenuineIntel\ncpu family\t: 6\nmodel\t\t: 143\n"
            "model name\t: Processor\nstepping\t: 3\n");
  EXPECT_EQ(xeon, processor_identity(cpuinfo("GenuineIntel", 143, 2750.5)))
      << "its clock changes from minute to minute";
  EXPECT_NE(xeon, processor_identity(cpuinfo("AuthenticAMD", 143, 2000)));
  EXPECT_NE(xeon, processor_identity(cpuinfo("GenuineIntel", 106, 2000)));
  EXPECT_EQ(processor_identity("CPU implementer\t: 0x41\nCPU part\t: 0xd0c\nBogoMIPS\t: 50\n"),
            "CPU implementer\t: 0x41\nCPU part\t: 0xd0c\n");
  EXPECT_EQ(processor_identity(""), "");
}

TEST(Machine, TheIdIsOfProcessorAndInstallation) {
  const std::string id = machine_id("xeon", "3d1219c7");
  EXPECT_EQ(id.size(), 16U);
  EXPECT_EQ(id, machine_id("xeon", "3d1219c7"));
  EXPECT_NE(id, machine_id("epyc", "3d1219c7")) << "a cloned system on another processor";
  EXPECT_NE(id, machine_id("xeon", "0e24aa01")) << "two machines of one make";
  EXPECT_NE(machine_id("ab", "c"), machine_id("a", "bc"));
}

TEST(Machine, ReportsWhatItCan) {
  const Machine machine = inspect_machine();
  EXPECT_EQ(machine.id.size(), 16U);
  EXPECT_GE(machine.cores, 1U);
  EXPECT_GT(machine.memory_bytes, 0U);
  EXPECT_GE(machine.page_bytes, 4096U);
  EXPECT_NE(machine.instructions, "");
  EXPECT_NE(machine.executable_hash, rays::fingerprint(std::string_view()));
  EXPECT_EQ(utc_now().size(), std::string_view("2024-05-31T14:07:09Z").size());
}

}  // namespace
}  // namespace beambench::bench
