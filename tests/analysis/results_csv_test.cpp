// results.csv: a row for each cell, and the columns that scripts and people rely on.

#include "harness/analysis/results_csv.hpp"

#include <algorithm>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/analysis/some_run.hpp"
#include "tests/measure/some_cell.hpp"

namespace beambench::analysis {
namespace {

using measure::CellRecord;
using measure::QueryPath;
using measure::RunFacts;

using Fields = std::vector<std::vector<std::string>>;

/// Reads CSV back by RFC 4180, independently of how it was written.
Fields fields_of_csv(const std::string& text) {
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
  EXPECT_EQ(csv_field("'x"), "''x")
      << "readers drop an apostrophe that was added, not the text's own";
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
  Fields read = fields_of_csv(csv_table(std::vector{row}));
  RC_ASSERT(read.size() == 2U);
  for (std::string& text : read[1]) {
    if (text.starts_with('\'')) text.erase(0, 1);
  }
  RC_ASSERT(read[1] == expected);
}

RC_GTEST_PROP(Csv, NumbersComeBackAsTheyWere, (double number)) {
  const Fields read = fields_of_csv(csv_table(std::vector{Row{{"number", number}}}));
  RC_ASSERT(std::stod(read[1][0]) == number);
}

TEST(Csv, ColumnsAreTheUnionInOrder) {
  const std::vector<Row> rows{{{"a", 1}, {"z", true}}, {{"a", 2}, {"b", 0.5}, {"z", nullptr}}};
  EXPECT_EQ(csv_table(rows), "a,b,z\n1,,true\n2,0.5,\n");
}

const RunFacts kRun{"id", "abc", true, "m", "Release", "-O3", "AVX2", 1};

/// The columns that scripts and people rely on, in order.
const char* const kContract =
    "schema_version,run_id,time_utc,commit,dirty,machine_id,build_type,flags,isa,structure_isa,"
    "library_version,library_geometry,threads,"
    "scene,frame,camera,scene_hash,rays_hash,seed,primitives,"
    "structure,parameters,width,height,samples,parameter_sets,outpaced,ray_kind,order,query,query_"
    "path,rays,hit_share,"
    "occluded_share,coherence,"
    "repetitions,blocks,disturbed,stop_reason,"
    "build_ms_median,build_ms_min,build_ms_mad,update_ms_median,update_ms_min,"
    "trace_ms_median,trace_ms_min,trace_ms_mad,"
    "trace_ms,trace_ms_ci_low,trace_ms_ci_high,trace_ms_pi_low,trace_ms_pi_high,trace_clock,"
    "trace_warm_ms_median,trace_warm_ms_ci_low,trace_warm_ms_ci_high,"
    "trace_warm_ms_pi_low,trace_warm_ms_pi_high,"
    "harness_ms,trace_net_ms_median,"
    "total_ms_median,total_ms_min,total_ms_mad,total_ms,total_ms_ci_low,total_ms_ci_high,"
    "total_ms_pi_low,total_ms_pi_high,"
    "total_ms_min_spread,"
    "clock_ghz_median,total_mcycles_median,total_mcycles_ci_low,total_mcycles_ci_high,"
    "total_mcycles_pi_low,total_mcycles_pi_high,"
    "build_cpu_ms_median,trace_cpu_ms_median,mprimitives_per_s,mrays_per_s,"
    "build_instructions,build_cycles,build_cache_misses,"
    "trace_instructions,trace_cycles,trace_cache_misses,"
    "memory_bytes,allocated_bytes,peak_build_bytes,bytes_per_primitive,"
    "nodes,leaves,empty_leaves,references,depth,tree_cost,"
    "sah_nodes,sah_leaves,sah_tests,sah_cost,epo,"
    "traversal_steps_per_ray,leaves_per_ray,empty_leaves_per_ray,box_tests_per_ray,"
    "primitive_tests_per_ray,sphere_tests_per_ray,cone_tests_per_ray,polygon_tests_per_ray,"
    "hits,agree,tie,graze,structure_error,embree_error,verdict\n";

TEST(CellRow, HasTheColumnsOfTheContract) {
  CellRecord cell = measure::some_cell();
  cell.work.counters.erase("clips");
  const std::string table = csv_table(std::vector{to_row(kRun, cell)});
  EXPECT_EQ(table.substr(0, table.find('\n') + 1), kContract);
}

TEST(CellRow, SummarizesTheRepetitions) {
  const Row row = to_row(kRun, measure::some_cell());
  EXPECT_EQ(row.at("schema_version"), kSchemaVersion);
  EXPECT_EQ(row.at("repetitions"), 7);
  EXPECT_EQ(row.at("build_ms_median"), 4.0);
  EXPECT_EQ(row.at("trace_ms_median"), 10.0);
  EXPECT_EQ(row.at("total_ms_median"), 14.0);
  EXPECT_EQ(row.at("trace_ms_ci_low"), 10.0);
  EXPECT_EQ(row.at("trace_ms_ci_high"), 10.0);
  EXPECT_EQ(row.at("total_ms"), 14.0);
  EXPECT_EQ(row.at("total_ms_ci_low"), 11.0);
  EXPECT_EQ(row.at("total_ms_ci_high"), 17.0);
  EXPECT_EQ(row.at("total_ms_min_spread"), 4.0) << "the fifth-lowest of seven";
  EXPECT_EQ(row.at("mrays_per_s"), 0.064);  // 640 rays in 10 ms
  EXPECT_EQ(row.at("traversal_steps_per_ray"), 2.0);
  EXPECT_EQ(row.at("clips_per_ray"), 0.1);
  EXPECT_TRUE(row.at("box_tests_per_ray").is_null());
  EXPECT_EQ(row.at("allocated_bytes"), 4096);
  EXPECT_EQ(row.at("peak_build_bytes"), 8192);
  EXPECT_EQ(row.at("isa"), "AVX2");
  EXPECT_TRUE(row.at("structure_isa").is_null()) << "the structure does not choose one";
}

TEST(CellRow, NamesTheInstructionSetThatTheStructureChose) {
  CellRecord cell = measure::some_cell();
  cell.statistics->instruction_set = "AVX3";
  EXPECT_EQ(to_row(kRun, cell).at("structure_isa"), "AVX3");
}

TEST(CellRow, HardwareCountsAreEmptyWhereTheMachineCountsNone) {
  const CellRecord cell = measure::some_cell();
  const Row row = to_row(kRun, cell);
  EXPECT_EQ(row.at("trace_instructions"), 1003);
  EXPECT_EQ(row.at("trace_cycles"), 500);
  EXPECT_TRUE(row.at("trace_cache_misses").is_null());
  EXPECT_TRUE(row.at("build_instructions").is_null());
}

TEST(CellRow, TheHarnesssShareIsThatOfTheSamePath) {
  CellRecord cell = measure::some_cell();
  Row row = to_row(kRun, cell);
  EXPECT_EQ(row.at("query_path"), "image-single");
  EXPECT_EQ(row.at("harness_ms"), 2.5);
  EXPECT_EQ(row.at("trace_net_ms_median"), 7.5);
  cell.harness = {QueryPath::kImageOwn, 0.0};
  row = to_row(kRun, cell);
  EXPECT_EQ(row.at("query_path"), "image-own");
  EXPECT_EQ(row.at("trace_net_ms_median"), 10.0);
  cell.harness = std::nullopt;  // as for a structure that could not be built
  EXPECT_TRUE(to_row(kRun, cell).at("query_path").is_null());
}

TEST(CellRow, TheFirstAndTheSecondTracesHaveAnIntervalEach) {
  CellRecord cell = measure::some_cell();
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
  CellRecord cell = measure::some_cell();
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
  CellRecord cell = measure::some_cell();
  cell.verdict = verify::Verdict::kMismatch;
  const Row row = to_row(kRun, cell);
  for (const auto& [column, value] : row.items()) {
    const bool is_time = column.find("_ms_") != std::string::npos || column == "harness_ms" ||
                         column == "trace_ms" || column == "total_ms" || column == "trace_clock" ||
                         column == "blocks" || column == "disturbed" ||
                         column.find("mcycles") != std::string::npos ||
                         column == "clock_ghz_median" || column == "mrays_per_s" ||
                         column == "mprimitives_per_s" || column.ends_with("_cycles") ||
                         column.ends_with("_instructions") || column.ends_with("_cache_misses");
    EXPECT_EQ(value.is_null(),
              is_time || column == "leaves_per_ray" || column == "empty_leaves_per_ray" ||
                  column == "box_tests_per_ray" || column == "primitive_tests_per_ray" ||
                  column == "frame" || column == "structure_isa" || column == "library_version" ||
                  column == "library_geometry" || column == "occluded_share" ||
                  column == "tree_cost" || column.starts_with("sah_") || column == "epo" ||
                  column == "sphere_tests_per_ray" || column == "cone_tests_per_ray" ||
                  column == "polygon_tests_per_ray")
        << column;
  }
}

TEST(Results, HaveARowOfEachCellInTheOrderOfThePlan) {
  measure::Run run = run_of({cell_of({"samet", {1.0, 2.0}}), cell_of({"embree", {3.0}})});
  run.cells[1].work.counters["own_counter"] = 2000;
  std::ostringstream out;
  write_results(out, run);
  std::vector<Row> rows;
  for (const CellRecord& cell : run.cells) rows.push_back(to_row(facts_of(run.manifest), cell));
  EXPECT_EQ(out.str(), csv_table(rows));
  EXPECT_EQ(rows[1].at("own_counter_per_ray"), 2.0);
  EXPECT_EQ(rows[0].at("machine_id"), "0123456789abcdef");
}

TEST(Results, OfAMergedRunHaveTheMachineOfTheirShard) {
  measure::Run run = run_of({cell_of({"samet", {1.0}}), cell_of({"embree", {3.0}})});
  run.cells[0].shard = 2;
  run.cells[1].shard = 1;
  const auto shard = [](int number, const char* machine, const char* isa) {
    return Row{{"number", number}, {"machine", {{"id", machine}}}, {"measurement", {{"isa", isa}}}};
  };
  run.manifest["shards"] = Row::array({shard(1, "first", "AVX2"), shard(2, "second", "AVX512")});
  std::ostringstream out;
  write_results(out, run);
  const Fields read = fields_of_csv(out.str());
  const auto field = [&](std::size_t row, const char* column) {
    const auto place = std::ranges::find(read.at(0), column) - read.at(0).begin();
    return read.at(row).at(static_cast<std::size_t>(place));
  };
  EXPECT_EQ(field(1, "machine_id"), "second");
  EXPECT_EQ(field(1, "isa"), "AVX512");
  EXPECT_EQ(field(2, "machine_id"), "first");
}

}  // namespace
}  // namespace beambench::analysis
