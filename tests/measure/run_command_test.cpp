// `beambench run` as a user runs it: exit codes, streams, and one sentence for each wrong request.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>

#include "tests/scenes/thrown_message.hpp"
#include "tests/temporary_folder.hpp"

namespace beambench::measure {
namespace {

using nlohmann::json;

class RunCommand : public testing::Test {
 protected:
  struct Result {
    int exit_code;
    std::string out;
    std::string err;
  };

  /// Runs `beambench run` with arguments for the shell, in the test's folder.
  Result run(const std::string& arguments) const { return call("run " + arguments); }

  Result call(const std::string& arguments) const {
    const std::string command = "cd '" + folder_.path().string() + "' && '" BEAMBENCH_BINARY "' " +
                                arguments + " >out 2>err";
    const int status = std::system(command.c_str());
    return {WEXITSTATUS(status), read_text(folder_.path() / "out"),
            read_text(folder_.path() / "err")};
  }

  void write_sweep(const json& structures) {
    const json sweep{{"name", "tiny"},
                     {"scenes", {"tetra:n=1"}},
                     {"structures", structures},
                     {"resolutions", {"8x8"}},
                     {"repetitions", {{"minimum", 2}, {"maximum", 2}}},
                     {"budget_seconds", 1},
                     {"warm_up_seconds", 0}};
    folder_.write("tiny.json", sweep.dump());
  }

  void expect_refused(const std::string& arguments, std::initializer_list<std::string_view> words) {
    const Result result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments;
    EXPECT_EQ(result.out, "") << arguments;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_TRUE(scenes::says(result.err, words));
  }

  TemporaryFolder folder_;
};

TEST_F(RunCommand, MeasuresAndPrintsWhereTheRecordIs) {
  write_sweep({"exhaustive", "null"});
  const Result result = run("tiny.json -o record");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "record/results.csv\n");
  EXPECT_TRUE(scenes::says(result.err, {"[1/2]", "[2/2]", "2 cells, all verified"}));
  EXPECT_EQ(run("--resume record").exit_code, 0);
  expect_refused("tiny.json -o record", {"already holds a run"});
}

TEST_F(RunCommand, WithoutAFolderItCreatesOne) {
  write_sweep({"null"});
  const Result result = run("tiny.json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(result.out.starts_with("results/runs/2")) << result.out;
  EXPECT_TRUE(result.out.ends_with("-tiny/results.csv\n")) << result.out;
}

TEST_F(RunCommand, EndsWith1WhenACellHasNoTimes) {
  write_sweep({"samet:max_level=8,max_references=1", "null"});
  const Result result = run("tiny.json -o record");
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_TRUE(scenes::says(result.err, {"error: tetra:n=1/", "max_references", "1 of 2 cells"}));
  EXPECT_EQ(result.out, "record/results.csv\n");
}

TEST_F(RunCommand, TheFilesAreRegeneratedFromTheLog) {
  write_sweep({"samet:max_level=3", "null"});
  EXPECT_EQ(run("tiny.json -o record").exit_code, 0);
  const auto record = folder_.path() / "record";
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(record)) {
    files[entry.path().filename().string()] = read_text(entry.path());
    if (entry.path().filename() != "run.jsonl") std::filesystem::remove(entry.path());
  }
  EXPECT_EQ(files.size(), 7U);
  const Result shown = call("analyze record");
  EXPECT_EQ(shown.exit_code, 0) << shown.err;
  EXPECT_TRUE(scenes::says(shown.out, {"samet", "null (reference)", "2 cells, all verified"}));
  EXPECT_EQ(call("analyze record --json").out, files["analysis.json"]);
  EXPECT_FALSE(std::filesystem::exists(record / "results.csv"));
  EXPECT_EQ(call("analyze record --write").exit_code, 0);
  for (const auto& [name, text] : files) {
    if (name == "google-benchmark.json") {  // its context describes the program that writes it
      EXPECT_EQ(json::parse(read_text(record / name))["benchmarks"],
                json::parse(text)["benchmarks"]);
    } else {
      EXPECT_EQ(read_text(record / name), text) << name;
    }
  }
  EXPECT_EQ(call("analyze .").exit_code, 2);
  EXPECT_TRUE(scenes::says(read_text(folder_.path() / "err"), {"holds no run"}));
}

TEST_F(RunCommand, GoogleBenchmarksFlagsWork) {
  write_sweep({"null", "exhaustive"});
  EXPECT_EQ(run("tiny.json --dry-run --benchmark_filter=null").out,
            "tetra:n=1/default/8x8/1/primary/null:rays=single\n");
  EXPECT_EQ(run("tiny.json --benchmark_list_tests --benchmark_filter=-null").out,
            "tetra:n=1/default/8x8/1/primary/exhaustive\n");
  const Result result =
      run("tiny.json -o record --benchmark_filter=null --benchmark_repetitions=7 "
          "--benchmark_context=who=me --benchmark_min_time=3");
  EXPECT_EQ(result.exit_code, 0);
  const json google = json::parse(read_text(folder_.path() / "record/google-benchmark.json"));
  EXPECT_EQ(google["context"]["who"], "me");
  const std::size_t repetitions = google["benchmarks"].size();
  EXPECT_GE(repetitions, 7U);  // those that other processes disturb are repeated
  EXPECT_TRUE(scenes::says(result.err, {"--benchmark_min_time has no effect",
                                        fmt::format("after {} repetitions", repetitions)}));
}

TEST_F(RunCommand, WrongRequestsGetOneSentence) {
  write_sweep({"null"});
  folder_.write("broken.json", "{\n  \"name\": oops\n}");
  folder_.write("file", "");
  expect_refused("", {"no sweep given", "--resume"});
  expect_refused("missing.json", {"missing.json: cannot be read: No such file"});
  expect_refused("broken.json", {"broken.json:2:11", "not JSON"});
  expect_refused("tiny.json -o file/record", {"cannot make the folder", "file/record"});
  expect_refused("tiny.json --benchmark_fliter=x", {"--benchmark_fliter"});
  expect_refused("tiny.json --benchmark_filter=zzz", {"'zzz'", "none of the 1 cells"});
  expect_refused("tiny.json -o a --resume b", {"excludes"});
  expect_refused("--resume .", {"'.' holds no run", "run.jsonl"});
}

}  // namespace
}  // namespace beambench::measure
