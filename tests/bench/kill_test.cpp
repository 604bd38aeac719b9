// A run that is cut off, at whatever moment, keeps every finished cell and is resumed.

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

#include "tests/number_from.hpp"
#include "tests/scenes/thrown_message.hpp"
#include "tests/temporary_folder.hpp"

namespace beambench::bench {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using nlohmann::json;

constexpr int kCells = 12;

/// `beambench run` in a process of its own, messages to a file.
class Process {
 public:
  Process(const fs::path& folder, std::vector<std::string> arguments) : id_(::fork()) {
    if (id_ == 0) execute(folder, std::move(arguments));
  }

  void send(int signal) const { ::kill(id_, signal); }
  /// The status as waitpid reports it, once the process has ended.
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

/// Does a line of CSV have a field of this value? The JSON may write the same number longer.
bool has_number(const std::string& line, double number) {
  std::istringstream fields(line);
  for (std::string field; std::getline(fields, field, ',');) {
    char* end = nullptr;
    if (std::strtod(field.c_str(), &end) == number && end != field.c_str()) return true;
  }
  return false;
}

class Kill : public testing::Test {
 protected:
  Kill() {
    const json sweep{{"name", "tiny"},
                     {"scenes", {"tetra:n=1", "tetra:n=2"}},
                     {"structures", {"null", "samet:max_level=3", "embree"}},
                     {"resolutions", {"8x8", "16x10"}},
                     {"repetitions", {{"minimum", 2}, {"maximum", 2}}},
                     {"budget_seconds", 0},
                     {"warm_up_seconds", 0}};
    folder_.write("tiny.json", sweep.dump());
  }

  /// Begins the run in `name`, or resumes it.
  Process start(const std::string& name) const {
    if (fs::exists(folder_.path() / name / "manifest.json")) {
      return {folder_.path(), {"--resume", name}};
    }
    return {folder_.path(), {"tiny.json", "-o", name}};
  }

  std::string err() const { return read_text(folder_.path() / "err"); }

  /// Every finished cell of a run: its file's name and contents.
  std::map<std::string, std::string> cells(const std::string& name) const {
    std::map<std::string, std::string> found;
    const fs::path cells = folder_.path() / name / "cells";
    if (!fs::exists(cells)) return found;
    for (const auto& entry : fs::directory_iterator(cells)) {
      const std::string file = entry.path().filename().string();
      if (!file.starts_with('.')) found[file] = read_text(entry.path());
    }
    return found;
  }

  /// The rows of results.csv without the header.
  std::vector<std::string> rows(const std::string& name) const {
    std::istringstream table(read_text(folder_.path() / name / "results.csv"));
    std::vector<std::string> lines;
    for (std::string line; std::getline(table, line);) lines.push_back(line);
    if (!lines.empty()) lines.erase(lines.begin());
    return lines;
  }

  void expect_kept(const std::map<std::string, std::string>& before, const std::string& name) {
    const auto after = cells(name);
    for (const auto& [file, contents] : before) {
      const auto found = after.find(file);
      ASSERT_NE(found, after.end()) << file << " is gone";
      EXPECT_EQ(found->second, contents) << file << " was measured again";
    }
    for (const auto& [file, contents] : after) {
      EXPECT_TRUE(json::accept(contents)) << file << " is not whole";
    }
  }

  /// Every cell once, every verdict right, every row that of its cell, nothing left over.
  void expect_complete(const std::string& name) {
    EXPECT_EQ(rows(name).size(), kCells);
    EXPECT_EQ(cells(name).size(), kCells);
    for (const std::string& row : rows(name)) {
      EXPECT_TRUE(row.ends_with(",ok") || row.ends_with(",baseline")) << row;
    }
    std::set<std::string> names;
    for (const auto& [file, contents] : cells(name)) {
      const json cell = json::parse(contents);
      names.insert(cell["name"].get<std::string>());
      EXPECT_EQ(cell["repetitions"].size(), 2U);
      const auto is_its_row = [time = cell["row"]["trace_ms_median"].get<double>()](
                                  const std::string& row) { return has_number(row, time); };
      EXPECT_TRUE(std::ranges::any_of(rows(name), is_its_row)) << contents;
    }
    EXPECT_EQ(names.size(), kCells);
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path() / name)) {
      EXPECT_EQ(entry.path().filename().string().find("partial"), std::string::npos) << entry;
    }
    const json manifest = json::parse(read_text(folder_.path() / name / "manifest.json"));
    EXPECT_FALSE(manifest["finished_utc"].is_null());
  }

  TemporaryFolder folder_;
};

TEST_F(Kill, AtRandomMomentsLosesNothing) {
  const std::uint64_t kills = tests::in_full(50, 20);
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
    const auto before = cells(name);
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
    // Before it has taken over the signal, SIGINT ends it as it ends any program.
    const bool ended_by_itself = signal == SIGINT && WIFEXITED(status);
    EXPECT_EQ(ended_by_itself ? WEXITSTATUS(status) : WTERMSIG(status),
              ended_by_itself ? 130 : signal)
        << err();
  }
  const std::string name = "run" + std::to_string(finished);
  const auto before = cells(name);
  ASSERT_EQ(start(name).wait(), 0) << err();
  expect_kept(before, name);
  expect_complete(name);
}

/// Waits until a run has a finished cell, and a little of the next.
void wait_for_a_cell(const fs::path& folder) {
  const fs::path results = folder / "results.csv";
  const auto end = Clock::now() + std::chrono::seconds(20);
  while (!fs::exists(results) && Clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

class Interrupted : public Kill, public testing::WithParamInterface<int> {};

TEST_P(Interrupted, EndsAtOnceAndSaysHowToContinue) {
  json sweep = json::parse(read_text(folder_.path() / "tiny.json"));
  sweep["resolutions"] = {"8x8", "2000x2000"};
  sweep["scenes"] = {"tetra:n=4"};
  sweep["structures"] = {"exhaustive"};
  folder_.write("tiny.json", sweep.dump());
  const Process process = start("my run");
  wait_for_a_cell(folder_.path() / "my run");
  const auto begin = Clock::now();
  process.send(GetParam());
  const int status = process.wait();
  EXPECT_LT(Clock::now() - begin, std::chrono::seconds(2));
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);
  const std::string resume = std::string(BEAMBENCH_BINARY) + " run --resume 'my run'\n";
  EXPECT_TRUE(err().ends_with("resume with: " + resume)) << err();
  EXPECT_EQ(cells("my run").size(), 1U);
}

INSTANTIATE_TEST_SUITE_P(, Interrupted, testing::Values(SIGINT, SIGTERM), [](const auto& signal) {
  return signal.param == SIGINT ? "INT" : "TERM";
});

TEST_F(Kill, TwoProcessesDoNotShareAFolder) {
  json sweep = json::parse(read_text(folder_.path() / "tiny.json"));
  sweep["warm_up_seconds"] = 30;
  folder_.write("tiny.json", sweep.dump());
  const Process first = start("run");
  const auto end = Clock::now() + std::chrono::seconds(20);
  while (!fs::exists(folder_.path() / "run" / "config.json") && Clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(WEXITSTATUS(start("run").wait()), 2);
  EXPECT_TRUE(scenes::says(err(), {"another beambench is at work in 'run'"}));
  first.send(SIGKILL);
  first.wait();
}

TEST_F(Kill, AChangedSceneFileIsNoticed) {
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
  const auto before = cells("run");
  write_scene("2");
  EXPECT_EQ(WEXITSTATUS(start("run").wait()), 2);
  EXPECT_TRUE(scenes::says(err(), {"cannot resume 'run'", "ball.nff", "has changed"}));
  write_scene("1");
  EXPECT_EQ(start("run").wait(), 0) << err();
  EXPECT_EQ(cells("run"), before);
}

/// A disk of some 40 KB, where this process may mount one.
class TinyDisk {
 public:
  explicit TinyDisk(fs::path path) : path_(std::move(path)) {
    fs::create_directories(path_);
    mounted_ = ::mount("none", path_.c_str(), "tmpfs", 0, "size=40k") == 0;
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

TEST_F(Kill, AFullDiskKeepsWhatIsFinished) {
  const TinyDisk disk(folder_.path() / "disk");
  if (!disk.mounted()) GTEST_SKIP() << "this process may not mount a small disk";
  EXPECT_EQ(WEXITSTATUS(start("disk/run").wait()), 2);
  EXPECT_TRUE(scenes::says(err(), {"cannot write 'disk/run/", "the disk of the folder 'disk/run",
                                   "is full", "make room", "beambench run --resume disk/run"}));
  const auto before = cells("disk/run");
  EXPECT_GT(before.size(), 0U);
  EXPECT_LT(before.size(), kCells);
  disk.make_room();
  ASSERT_EQ(start("disk/run").wait(), 0) << err();
  expect_kept(before, "disk/run");
  expect_complete("disk/run");
}

}  // namespace
}  // namespace beambench::bench
