// A run interrupted at any moment keeps every repetition and can be resumed.

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/measure/record/cell_json.hpp"
#include "harness/measure/record/robust_statistics.hpp"
#include "tests/number_from.hpp"
#include "tests/scenes/thrown_message.hpp"
#include "tests/temporary_folder.hpp"

namespace beambench::measure {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using nlohmann::json;

constexpr int kCells = 12;
constexpr int kRepetitions = 2;  ///< of each cell

/// `beambench run` in its own process, with its messages in a file.
class Process {
 public:
  Process(const fs::path& folder, std::vector<std::string> arguments) : id_(::fork()) {
    if (id_ == 0) execute(folder, std::move(arguments));
  }

  void send(int signal) const { ::kill(id_, signal); }
  /// Returns the status as reported by waitpid, once the process has ended.
  int wait() const {
    int status = 0;
    ::waitpid(id_, &status, 0);
    return status;
  }

 private:
  [[noreturn]] static void execute(const fs::path& folder, std::vector<std::string> arguments) {
    for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, SIG_DFL);
    if (::chdir(folder.c_str()) != 0) std::_Exit(99);
    const auto to_file = [](const char* name, int stream) {
      ::dup2(::open(name, O_WRONLY | O_CREAT | O_TRUNC, 0666), stream);
    };
    to_file("out", STDOUT_FILENO);
    to_file("err", STDERR_FILENO);
    arguments.insert(arguments.begin(), {BEAMBENCH_BINARY, "run"});
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    ::execv(BEAMBENCH_BINARY, pointers.data());
    std::_Exit(99);
  }

  pid_t id_;
};

/// Returns whether a line of CSV has a field with this value, however many digits are printed.
bool has_number(const std::string& line, double number) {
  std::istringstream fields(line);
  for (std::string field; std::getline(fields, field, ',');) {
    char* end = nullptr;
    if (std::strtod(field.c_str(), &end) == number && end != field.c_str()) return true;
  }
  return false;
}

/// Returns the events of this kind in a log of whole lines.
std::vector<json> events_of(const std::string& log, const char* kind) {
  std::istringstream lines(log);
  std::vector<json> found;
  for (std::string line; std::getline(lines, line);) {
    const json event = json::parse(line);
    if (event.at("event") == kind) found.push_back(event);
  }
  return found;
}

class Kill : public testing::Test {
 protected:
  Kill() {
    const json sweep{{"name", "tiny"},
                     {"scenes", {"tetra:n=1", "tetra:n=2"}},
                     {"structures", {"null", "samet:max_level=3", "embree"}},
                     {"resolutions", {"8x8", "16x10"}},
                     {"repetitions", {{"minimum", kRepetitions}, {"maximum", kRepetitions}}},
                     {"budget_seconds", 0},
                     {"warm_up_seconds", 0}};
    folder_.write("tiny.json", sweep.dump());
  }

  /// Begins the run in `name`, or resumes it.
  Process start(const std::string& name) const {
    if (fs::exists(folder_.path() / name / "run.jsonl")) {
      return {folder_.path(), {"--resume", name}};
    }
    return {folder_.path(), {"tiny.json", "-o", name}};
  }

  std::string err() const { return read_text(folder_.path() / "err"); }

  /// Returns the whole lines of a run's log; empty if there is none.
  std::string log(const std::string& name) const {
    const std::string text = read_text(folder_.path() / name / "run.jsonl");
    return text.substr(0, text.rfind('\n') + 1);
  }

  /// Returns the events of this kind in a run's log.
  std::vector<json> events(const std::string& name, const char* kind) const {
    return events_of(log(name), kind);
  }

  /// Returns the rows of results.csv without the header.
  std::vector<std::string> rows(const std::string& name) const {
    std::istringstream table(read_text(folder_.path() / name / "results.csv"));
    std::vector<std::string> lines;
    for (std::string line; std::getline(table, line);) lines.push_back(line);
    if (!lines.empty()) lines.erase(lines.begin());
    return lines;
  }

  /// Returns the repetitions in a run's log, by cell.
  std::map<int, std::vector<Repetition>> repetitions(const std::string& name) const {
    std::map<int, std::vector<Repetition>> found;
    for (const json& one : events(name, "repetition")) {
      found[one["index"].get<int>()].push_back(read_repetition(one));
    }
    return found;
  }

  /// Expects the log to be preserved and no repetition to be repeated except those that another
  /// process disturbed.
  void expect_kept(const std::string& before, const std::string& name) {
    EXPECT_TRUE(log(name).starts_with(before)) << before << "became\n" << log(name);
    for (const auto& [cell, made] : repetitions(name)) {
      std::map<int, const Repetition*> last_of_round;
      for (const Repetition& one : made) {
        const auto [last, is_new] = last_of_round.emplace(one.round, &one);
        EXPECT_TRUE(is_new || !last->second->is_undisturbed())
            << "cell " << cell << ", round " << one.round;
        last->second = &one;
      }
      EXPECT_LE(last_of_round.size(), std::size_t{kRepetitions}) << "cell " << cell;
    }
  }

  /// Expects every cell once, correct verdicts, each row to match its cell, and nothing else.
  void expect_complete(const std::string& name) {
    EXPECT_EQ(rows(name).size(), kCells);
    for (const std::string& row : rows(name)) {
      EXPECT_TRUE(row.ends_with(",ok") || row.ends_with(",baseline")) << row;
    }
    const auto all = repetitions(name);
    EXPECT_EQ(all.size(), kCells);
    for (const auto& [cell, made] : all) {
      std::vector<double> times;
      std::set<int> rounds;
      for (const Repetition& one : made) {
        times.push_back(one.trace_ms);
        rounds.insert(one.round);
      }
      EXPECT_EQ(rounds.size(), std::size_t{kRepetitions}) << "cell " << cell;
      const auto is_its_row = [time = median(times)](const std::string& row) {
        return has_number(row, time);
      };
      EXPECT_TRUE(std::ranges::any_of(rows(name), is_its_row)) << "cell " << cell;
    }
    EXPECT_EQ(events(name, "finished").size(), kCells);
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path() / name)) {
      EXPECT_EQ(entry.path().filename().string().find("partial"), std::string::npos) << entry;
    }
    const json manifest = json::parse(read_text(folder_.path() / name / "manifest.json"));
    EXPECT_FALSE(manifest["finished_utc"].is_null());
  }

  /// Makes the first cell of the sweep quick and the next one slow.
  void make_second_cell_long() const {
    json sweep = json::parse(read_text(folder_.path() / "tiny.json"));
    sweep["resolutions"] = {"8x8", "2000x2000"};
    sweep["scenes"] = {"tetra:n=4"};
    sweep["structures"] = {"exhaustive"};
    folder_.write("tiny.json", sweep.dump());
  }

  /// Waits until a run has finished a cell.
  void wait_for_a_repetition(const std::string& name) const {
    const auto end = Clock::now() + std::chrono::seconds(20);
    while (events(name, "repetition").empty() && Clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  TemporaryFolder folder_;
};

TEST_F(Kill, AtRandomTimesLosesNothing) {
  const std::uint64_t kills = tests::in_full(625, 20);  // four of five by SIGKILL
  const auto begin = Clock::now();
  ASSERT_EQ(start("undisturbed").wait(), 0) << err();
  const std::chrono::duration<double> whole = Clock::now() - begin;
  expect_complete("undisturbed");

  std::mt19937_64 random(1999);
  std::uniform_real_distribution<double> moment(0.0, 1.0);
  std::uint64_t killed = 0;
  int finished = 0;
  while (killed < kills) {
    const std::string name = "run" + std::to_string(finished);
    const std::string before = log(name);
    const int signal = killed % 5 == 4 ? SIGINT : SIGKILL;
    const Process process = start(name);
    std::this_thread::sleep_for(whole * moment(random));
    process.send(signal);
    const int status = process.wait();
    if (HasFatalFailure()) return;
    expect_kept(before, name);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) {
      expect_complete(name);
      ++finished;
      continue;
    }
    ++killed;
    // Before the handler is installed, SIGINT ends the program as usual.
    const bool ended_by_itself = signal == SIGINT && WIFEXITED(status);
    EXPECT_EQ(ended_by_itself ? WEXITSTATUS(status) : WTERMSIG(status),
              ended_by_itself ? 130 : signal)
        << err();
  }
  const std::string name = "run" + std::to_string(finished);
  const std::string before = log(name);
  ASSERT_EQ(start(name).wait(), 0) << err();
  expect_kept(before, name);
  expect_complete(name);
}

class Interrupted : public Kill, public testing::WithParamInterface<int> {};

TEST_P(Interrupted, EndsImmediatelyAndPrintsHowToContinue) {
  make_second_cell_long();
  const Process process = start("my run");
  wait_for_a_repetition("my run");
  const auto begin = Clock::now();
  process.send(GetParam());
  const int status = process.wait();
  EXPECT_LT(Clock::now() - begin, std::chrono::seconds(2));
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);
  const std::string resume = std::string(BEAMBENCH_BINARY) + " run --resume 'my run'\n";
  EXPECT_TRUE(err().ends_with("interrupted; every repetition is kept; resume with: " + resume))
      << err();
  EXPECT_GE(events("my run", "repetition").size(), 1U);
}

INSTANTIATE_TEST_SUITE_P(, Interrupted, testing::Values(SIGINT, SIGTERM), [](const auto& signal) {
  return signal.param == SIGINT ? "INT" : "TERM";
});

TEST_F(Kill, TwoProcessesDoNotShareAFolder) {
  make_second_cell_long();
  const Process first = start("run");
  wait_for_a_repetition("run");
  EXPECT_EQ(WEXITSTATUS(start("run").wait()), 2);
  EXPECT_TRUE(scenes::says(err(), {"another beambench is at work in 'run'"}));
  first.send(SIGKILL);
  first.wait();
}

TEST_F(Kill, AChangedSceneFileIsDetected) {
  const auto write_scene = [&](const char* radius) {
    folder_.write("ball.nff", std::string("v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 1\n"
                                          "resolution 8 8\nb 0 0 0\nl 9 9 9\n"
                                          "f 1 1 1 1 0 0 0 1\ns 0 0 0 ") +
                                  radius + '\n');
  };
  json sweep = json::parse(read_text(folder_.path() / "tiny.json"));
  sweep["scenes"] = {"ball.nff"};
  folder_.write("tiny.json", sweep.dump());
  write_scene("1");
  ASSERT_EQ(start("run").wait(), 0) << err();
  const std::string before = log("run");
  write_scene("2");
  EXPECT_EQ(WEXITSTATUS(start("run").wait()), 2);
  EXPECT_TRUE(scenes::says(err(), {"cannot resume 'run'", "ball.nff", "has changed"}));
  EXPECT_EQ(log("run"), before);
  write_scene("1");
  EXPECT_EQ(start("run").wait(), 0) << err();
  EXPECT_EQ(events("run", "repetition"), events_of(before, "repetition"));
}

/// A small disk, if this process may mount one.
class TinyDisk {
 public:
  TinyDisk(fs::path path, const char* size) : path_(std::move(path)) {
    fs::create_directories(path_);
    mounted_ = ::mount("none", path_.c_str(), "tmpfs", 0, size) == 0;
  }
  ~TinyDisk() {
    if (mounted_) ::umount2(path_.c_str(), MNT_DETACH);
  }
  TinyDisk(const TinyDisk&) = delete;
  TinyDisk& operator=(const TinyDisk&) = delete;

  bool mounted() const { return mounted_; }
  void make_room() const { ::mount("none", path_.c_str(), "tmpfs", MS_REMOUNT, "size=4m"); }

 private:
  fs::path path_;
  bool mounted_ = false;
};

/// A size of the disk, named after the data that no longer fits on it, and the minimum and maximum
/// number of repetitions in the log by then.
struct FullDisk {
  const char* name;
  const char* size;
  std::size_t fewest;
  std::size_t most;
};

class AFullDisk : public Kill, public testing::WithParamInterface<FullDisk> {};

TEST_P(AFullDisk, KeepsTheContentOfTheLog) {
  const TinyDisk disk(folder_.path() / "disk", GetParam().size);
  if (!disk.mounted()) GTEST_SKIP() << "this process may not mount a small disk";
  EXPECT_EQ(WEXITSTATUS(start("disk/run").wait()), 2);
  EXPECT_TRUE(scenes::says(err(), {"cannot write 'disk/run/", "the disk of the folder 'disk/run",
                                   "is full", "make room", "beambench run --resume disk/run"}));
  const std::string before = log("disk/run");
  EXPECT_GE(events_of(before, "repetition").size(), GetParam().fewest);
  EXPECT_LE(events_of(before, "repetition").size(), GetParam().most);
  disk.make_room();
  ASSERT_EQ(start("disk/run").wait(), 0) << err();
  expect_kept(before, "disk/run");
  expect_complete("disk/run");
}

INSTANTIATE_TEST_SUITE_P(, AFullDisk,
                         testing::Values(FullDisk{"TheLog", "size=16k", 1,
                                                  kCells* kRepetitions - 1},
                                         FullDisk{"WhatIsMadeFromIt", "size=32k",
                                                  kCells* kRepetitions, 3 * kCells* kRepetitions}),
                         [](const auto& disk) { return disk.param.name; });

}  // namespace
}  // namespace beambench::measure
