// The log of a run: its events are read back as written, however it was interrupted.

#include "harness/measure/record/run_log.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "harness/measure/record/cell_json.hpp"
#include "tests/measure/some_cell.hpp"
#include "tests/scenes/thrown_message.hpp"
#include "tests/temporary_folder.hpp"

namespace beambench::measure {
namespace {

using scenes::says;
using scenes::thrown_message;
using Events = std::vector<nlohmann::ordered_json>;

/// Returns a manifest with the members that events change.
nlohmann::ordered_json small_manifest() {
  return {{"run_id", "id"},
          {"finished_utc", nullptr},
          {"measurement", {{"throttling", nullptr}}},
          {"uncontrolled", {"It is noisy."}}};
}

std::vector<PlannedName> plan_of(std::span<const CellRecord> cells) {
  std::vector<PlannedName> plan;
  for (const CellRecord& cell : cells) plan.push_back({cell.index, cell.id.name()});
  return plan;
}

/// Returns the cell as it was after this many repetitions.
CellRecord after(CellRecord cell, std::size_t repetitions) {
  cell.repetitions.resize(repetitions);
  return cell;
}

CellEvents events_of(RunLog& log) {
  return CellEvents([&log](const nlohmann::ordered_json& event) { log.add(event); });
}

void log_cell(RunLog& log, const CellRecord& cell) {
  const CellEvents events = events_of(log);
  events.begin_cell(cell);
  if (cell.diff) events.add_verification(cell);
  for (std::size_t i = 1; i <= cell.repetitions.size(); ++i) {
    events.add_repetition(after(cell, i));
  }
  if (cell.is_finished) events.finish_cell(cell);
}

Events events_in(const std::filesystem::path& folder) {
  Events events;
  for_each_event(folder, [&](const auto& event) { events.push_back(event); });
  return events;
}

const rc::Gen<std::string> kText =
    rc::gen::container<std::string>(rc::gen::inRange(static_cast<char>(1), static_cast<char>(127)));

template <class Value>
std::optional<Value> drawn_or_nothing() {
  return *rc::gen::arbitrary<bool>() ? std::optional(*rc::gen::arbitrary<Value>()) : std::nullopt;
}

HardwareCounts drawn_counts() {
  HardwareCounts counts;
  for (auto& count : counts) count = drawn_or_nothing<std::uint64_t>();
  return counts;
}

NamedCounters drawn_counters() {
  const auto drawn = *rc::gen::container<std::map<std::string, std::uint64_t>>(
      kText, rc::gen::arbitrary<std::uint64_t>());
  return {drawn.begin(), drawn.end()};
}

Repetition drawn_repetition(int round) {
  Repetition repetition{};
  repetition.round = round;
  repetition.position = *rc::gen::inRange(0, 9);
  for (double* time : {&repetition.build_ms, &repetition.trace_ms, &repetition.build_cpu_ms,
                       &repetition.trace_cpu_ms, &repetition.clock_ghz}) {
    *time = *rc::gen::arbitrary<double>();
  }
  repetition.build_counts = drawn_counts();
  repetition.trace_counts = drawn_counts();
  repetition.warm_trace_ms = drawn_or_nothing<double>();
  return repetition;
}

verify::Verdict drawn_verdict() {
  return static_cast<verify::Verdict>(
      *rc::gen::inRange(0, 1 + static_cast<int>(verify::Verdict::kNoRays)));
}

RaySetFacts drawn_facts() {
  RaySetFacts facts;
  for (std::uint64_t* number :
       {&facts.scene_hash, &facts.rays_hash, &facts.seed, &facts.primitives, &facts.rays}) {
    *number = *rc::gen::arbitrary<std::uint64_t>();
  }
  facts.query =
      static_cast<rays::Query>(*rc::gen::inRange(0, 1 + static_cast<int>(rays::Query::kPicture)));
  facts.hit_share = drawn_or_nothing<double>();
  facts.occluded_share = drawn_or_nothing<double>();
  facts.coherence = drawn_or_nothing<double>();
  return facts;
}

accel::Statistics drawn_statistics() {
  accel::Statistics statistics;
  for (std::uint64_t* number : {&statistics.nodes, &statistics.leaves, &statistics.empty_leaves,
                                &statistics.references, &statistics.depth, &statistics.bytes}) {
    *number = *rc::gen::arbitrary<std::uint64_t>();
  }
  statistics.instruction_set = *kText;
  statistics.library_geometry = *kText;
  statistics.library_version = *kText;
  if (*rc::gen::arbitrary<bool>()) {
    statistics.more = {{"sah_nodes", *rc::gen::arbitrary<double>()}, {"cost", 0.1}};
  }
  return statistics;
}

CellRecord drawn_cell(std::size_t index) {
  CellRecord cell{};
  cell.index = index;
  cell.id = {*kText,
             *kText,
             *kText,
             *kText,
             {*rc::gen::inRange(1, 9999), *rc::gen::inRange(1, 9999)},
             *rc::gen::inRange(1, 99),
             *kText};
  cell.rays = drawn_facts();
  cell.work.counters = drawn_counters();
  for (const char* kind : {"camera", "shadow"}) {
    if (!*rc::gen::arbitrary<bool>()) continue;
    cell.work.kinds.push_back({kind, *rc::gen::arbitrary<std::uint64_t>(), drawn_counters()});
  }
  if (*rc::gen::arbitrary<bool>()) cell.statistics = drawn_statistics();
  cell.allocated_bytes = drawn_or_nothing<std::uint64_t>();
  cell.peak_build_bytes = drawn_or_nothing<std::uint64_t>();
  if (*rc::gen::arbitrary<bool>()) {
    cell.harness = {static_cast<QueryPath>(*rc::gen::inRange(0, 6)), *rc::gen::arbitrary<double>()};
  }
  if (*rc::gen::arbitrary<bool>()) {
    cell.diff.emplace();
    cell.diff->rays = *rc::gen::arbitrary<std::uint64_t>();
    cell.diff->hits = *rc::gen::arbitrary<std::uint64_t>();
    for (auto& count : cell.diff->counts) count = *rc::gen::arbitrary<std::uint64_t>();
    cell.diff->verdict = cell.verdict = drawn_verdict();
    cell.hits_hash = *rc::gen::arbitrary<std::uint64_t>();
  }
  const int repetitions = *rc::gen::inRange(0, 4);
  for (int i = 0; i < repetitions; ++i) cell.repetitions.push_back(drawn_repetition(2 * i));
  cell.is_finished = *rc::gen::arbitrary<bool>();
  if (!cell.is_finished) return cell;
  cell.verdict = drawn_verdict();
  cell.time_utc = *kText;
  cell.message = *kText;
  cell.examples = *rc::gen::container<std::vector<std::string>>(kText);
  if (*rc::gen::arbitrary<bool>()) {
    cell.stop_reason = static_cast<StopReason>(*rc::gen::inRange(0, 3));
  }
  return cell;
}

auto members_of(const Repetition& one) {
  return std::tie(one.round, one.position, one.build_ms, one.trace_ms, one.build_cpu_ms,
                  one.trace_cpu_ms, one.build_counts, one.trace_counts, one.warm_trace_ms,
                  one.clock_ghz);
}

auto members_of(const RaySetFacts& facts) {
  return std::tie(facts.scene_hash, facts.rays_hash, facts.seed, facts.primitives, facts.rays,
                  facts.query, facts.hit_share, facts.occluded_share, facts.coherence);
}

auto members_of(const accel::Statistics& sizes) {
  return std::tie(sizes.nodes, sizes.leaves, sizes.empty_leaves, sizes.references, sizes.depth,
                  sizes.bytes, sizes.instruction_set, sizes.library_geometry, sizes.library_version,
                  sizes.more);
}

auto members_of(const verify::DiffReport& report) {
  return std::tie(report.rays, report.hits, report.counts, report.verdict);
}

auto members_of(const HarnessShare& share) { return std::tie(share.path, share.ms); }

auto members_of(const RaysOfKind& kind) { return std::tie(kind.kind, kind.rays, kind.counters); }

auto members_of(const CellId& id) {
  return std::tie(id.scene, id.camera, id.structure, id.parameters, id.resolution.width,
                  id.resolution.height, id.samples, id.rays);
}

template <class Value>
bool is_same(const Value& one, const Value& other) {
  return members_of(one) == members_of(other);
}
template <class Value>
bool is_same(const std::optional<Value>& one, const std::optional<Value>& other) {
  return one.has_value() == other.has_value() && (!one || is_same(*one, *other));
}
template <class Value>
bool is_same(const std::vector<Value>& one, const std::vector<Value>& other) {
  return std::ranges::equal(one, other,
                            [](const Value& a, const Value& b) { return is_same(a, b); });
}

void expect_same(const CellRecord& read, const CellRecord& written) {
  RC_ASSERT(read.index == written.index);
  RC_ASSERT(is_same(read.id, written.id));
  RC_ASSERT(is_same(read.rays, written.rays));
  RC_ASSERT(read.work.counters == written.work.counters);
  RC_ASSERT(is_same(read.work.kinds, written.work.kinds));
  RC_ASSERT(is_same(read.statistics, written.statistics));
  RC_ASSERT(read.allocated_bytes == written.allocated_bytes);
  RC_ASSERT(read.peak_build_bytes == written.peak_build_bytes);
  RC_ASSERT(is_same(read.harness, written.harness));
  RC_ASSERT(is_same(read.repetitions, written.repetitions));
  RC_ASSERT(is_same(read.diff, written.diff));
  RC_ASSERT(read.hits_hash == written.hits_hash);
  RC_ASSERT(read.is_finished == written.is_finished);
  RC_ASSERT(read.time_utc == written.time_utc);
  RC_ASSERT(read.stop_reason == written.stop_reason);
  RC_ASSERT(read.verdict == written.verdict);
  RC_ASSERT(read.message == written.message);
  RC_ASSERT(read.examples == written.examples);
  RC_ASSERT(read.shard == 0);
}

RC_GTEST_PROP(RunLog, CellsComeBackAsTheyWereWritten, ()) {
  const TemporaryFolder folder;
  std::vector<CellRecord> cells;
  const std::size_t count = *rc::gen::inRange<std::size_t>(1, 4);
  for (std::size_t i = 0; i < count; ++i) cells.push_back(drawn_cell(3 * i));
  {
    RunLog log = RunLog::create(folder.path() / "run");
    log.begin(small_manifest(), {{"name", "x"}}, plan_of(cells));
    for (auto cell = cells.rbegin(); cell != cells.rend(); ++cell) log_cell(log, *cell);
  }
  const auto run = read_run(folder.path() / "run");
  RC_ASSERT(run.manifest == small_manifest());
  RC_ASSERT(run.config == nlohmann::json({{"name", "x"}}));
  RC_ASSERT(run.plan.size() == cells.size());
  for (std::size_t i = 0; i < count; ++i) {
    RC_ASSERT(run.plan[i].index == cells[i].index);
    RC_ASSERT(run.plan[i].name == cells[i].id.name());
  }
  std::erase_if(cells, [](const CellRecord& cell) { return !cell.is_finished && !cell.diff; });
  RC_ASSERT(run.cells.size() == cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) expect_same(run.cells[i], cells[i]);
}

TEST(RunLog, HasOnlyTheCountsThatTheMachineProvides) {
  const auto repetition = repetition_json(some_cell().repetitions.front());
  EXPECT_EQ(repetition.at("trace_instructions"), 1000);
  EXPECT_FALSE(repetition.contains("trace_cache_misses"));
  EXPECT_FALSE(repetition.contains("build_instructions"));
}

TEST(RunLog, LaterEventsChangeTheManifest) {
  const TemporaryFolder folder;
  {
    RunLog log = RunLog::create(folder.path());
    log.begin(small_manifest(), {}, {});
    events_of(log).warn("The rays never hit.");
    log.begin_block("tetra", 0, 0.75);
    log.begin_block("tetra", 1, 0.5);
    log.begin_block("tetra", 2, std::nullopt);
    log.set_throttling({10, 3, 0.5});
    log.set_throttling({20, 4, 0.75});
  }
  auto run = read_run(folder.path());
  EXPECT_FALSE(run.is_ended());
  EXPECT_EQ(run.manifest.at("uncontrolled"), Events({"It is noisy.", "The rays never hit."}));
  EXPECT_EQ(run.manifest.at("measurement").at("throttling").at("periods"), 20);
  EXPECT_EQ(run.manifest.at("measurement").at("other_work"), 0.5);
  {
    auto resumed = small_manifest();
    resumed["part_begun_utc"] = "later";
    RunLog log = RunLog::open(folder.path());
    log.resume(resumed, run.log_bytes);
    log.end("2026-01-01T00:00:00Z");
  }
  run = read_run(folder.path());
  EXPECT_TRUE(run.is_ended());
  EXPECT_EQ(run.manifest.at("part_begun_utc"), "later");
  EXPECT_EQ(run.manifest.at("uncontrolled"), Events({"It is noisy."}));
  EXPECT_EQ(run.manifest.at("finished_utc"), "2026-01-01T00:00:00Z");
}

/// The log of two cells, the second unfinished.
class WrittenLog : public testing::Test {
 protected:
  WrittenLog() {
    CellRecord first = some_cell();
    first.repetitions.resize(3);
    first.hits_hash = 7;
    first.is_finished = true;
    CellRecord second = first;
    second.index = 1;
    second.id.samples = 4;
    second.is_finished = false;
    RunLog log = RunLog::create(folder());
    log.begin(small_manifest(), {{"name", "x"}}, plan_of(std::vector{first, second}));
    log_cell(log, first);
    log_cell(log, second);
    text_ = read_text(file());
  }

  std::filesystem::path folder() const { return folder_.path() / "run"; }
  std::filesystem::path file() const { return folder() / kLogName; }
  void write(const std::string& text) const { folder_.write("run/run.jsonl", text); }
  /// Returns the message with which a log with this text is refused.
  std::string refusal(const std::string& text) const {
    write(text);
    return thrown_message([&] { read_run(folder()); });
  }
  /// Returns the log with a part replaced.
  std::string with(const std::string& part, const std::string& other) const {
    std::string changed = text_;
    const auto place = changed.find(part);
    EXPECT_NE(place, std::string::npos) << part;
    return changed.replace(place, part.size(), other);
  }

  TemporaryFolder folder_;
  std::string text_;
};

TEST_F(WrittenLog, TruncatedAnywhereKeepsItsWholeLines) {
  const Events all = events_in(folder());
  ASSERT_EQ(all.size(), 12U);
  for (std::size_t bytes = 0; bytes <= text_.size(); ++bytes) {
    const std::string cut = text_.substr(0, bytes);
    const auto lines = static_cast<std::size_t>(std::ranges::count(cut, '\n'));
    if (lines == 0) {
      ASSERT_TRUE(says(refusal(cut), {"run/run.jsonl", "does not contain a whole line", "-o"}))
          << bytes;
      continue;
    }
    write(cut);
    ASSERT_EQ(events_in(folder()), Events(all.begin(), all.begin() + static_cast<int>(lines)))
        << bytes;
    const auto run = read_run(folder());
    std::size_t repetitions = 0;
    for (const CellRecord& cell : run.cells) repetitions += cell.repetitions.size();
    ASSERT_EQ(repetitions,
              std::count_if(all.begin(), all.begin() + static_cast<int>(lines),
                            [](const auto& event) { return event.at("event") == "repetition"; }))
        << bytes;
  }
}

TEST_F(WrittenLog, TruncatedAnywhereIsContinuedAfterItsLastWholeLine) {
  for (std::size_t bytes = text_.find('\n') + 1; bytes <= text_.size(); ++bytes) {
    const std::string cut = text_.substr(0, bytes);
    write(cut);
    RunLog::open(folder()).resume(small_manifest(), read_run(folder()).log_bytes);
    const std::string whole = cut.substr(0, cut.rfind('\n') + 1);
    const nlohmann::ordered_json resumed{{"event", "resumed"}, {"manifest", small_manifest()}};
    ASSERT_EQ(read_text(file()), whole + resumed.dump() + '\n') << bytes;
  }
}

TEST_F(WrittenLog, TruncatedInItsHeaderIsRefused) {
  write(text_.substr(0, text_.find('\n')));
  EXPECT_TRUE(says(thrown_message([&] { read_run(RunLog::open(folder()).folder()); }),
                   {"run/run.jsonl", "does not contain a whole line"}));
}

TEST_F(WrittenLog, DamagedInsideIsRefusedAtItsLine) {
  EXPECT_TRUE(says(refusal(with(R"({"event":"verification")", R"(?"event":"verification")")),
                   {"run/run.jsonl, line 3"}));
  EXPECT_TRUE(says(refusal(with(R"("round":0)", R"("round":"first")")),
                   {"run/run.jsonl, line 4", "not as it was written", "-o"}));
  EXPECT_TRUE(says(refusal(with(R"("index":0,"name")", R"("name")")),
                   {"run/run.jsonl, line 2", "not as it was written"}));
  EXPECT_TRUE(says(refusal(with(R"("hits_hash":"0000000000000007")", R"("hits_hash":"7 or so")")),
                   {"run/run.jsonl, line 3", "'7 or so'", "-o"}));
  EXPECT_TRUE(says(refusal(with(R"("verdict":"ok")", R"("verdict":"good")")),
                   {"run/run.jsonl, line 3", "'good'"}));
  EXPECT_TRUE(says(refusal(with("\n", "\n\n")), {"run/run.jsonl, line 2"}));
  EXPECT_TRUE(says(refusal(with("\n", "\n" + std::string(400'000, '[') + '\n')),
                   {"run/run.jsonl, line 2", "64 levels"}));
}

TEST_F(WrittenLog, WithACellOfAnUnknownShardIsRefused) {
  EXPECT_TRUE(says(refusal(with(R"("event":"cell",)", R"("event":"cell","shard":5,)")),
                   {"run/run.jsonl", "cell 0 belongs to shard 5", "-o"}));
}

TEST_F(WrittenLog, OfAnotherVersionIsRefused) {
  EXPECT_TRUE(says(refusal(with(R"("schema_version":2)", R"("schema_version":3)")),
                   {"run/run.jsonl, line 1", "version 3", "reads versions 1 to 2", "-o"}));
}

TEST_F(WrittenLog, WithAnUnknownEventIsRefused) {
  EXPECT_TRUE(says(refusal(with(R"("event":"finished")", R"("event":"celebrated")")),
                   {"run/run.jsonl, line 7", "'celebrated'", "-o"}));
}

TEST_F(WrittenLog, BeginsWithItsOnlyHeader) {
  const std::size_t second = text_.find('\n') + 1;
  EXPECT_TRUE(says(refusal(text_.substr(second)),
                   {"run/run.jsonl, line 1", "does not begin with its header"}));
  EXPECT_TRUE(
      says(refusal(text_.substr(0, second) + text_), {"run/run.jsonl, line 2", "second header"}));
}

TEST_F(WrittenLog, IsNotOverwrittenByANewRun) {
  EXPECT_TRUE(says(thrown_message([&] { RunLog::create(folder()); }),
                   {folder().string(), "already holds a run", "--resume"}));
  EXPECT_EQ(read_text(file()), text_);
}

TEST_F(WrittenLog, BelongsToOneAtATime) {
  const RunLog log = RunLog::open(folder());
  for (const auto& take : {&RunLog::open, &RunLog::create}) {
    EXPECT_TRUE(says(thrown_message([&] { take(folder()); }), {"another beambench", "wait until"}));
  }
}

TEST(RunLog, AcceptsAFolderWithoutMeasurements) {
  const TemporaryFolder folder;
  RunLog::create(folder.path() / "run");  // killed before its header was written
  folder.write("run/.run.123.partial.jsonl", "{");
  RunLog::create(folder.path() / "run").begin(small_manifest(), {}, {});
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "run/.run.123.partial.jsonl"));
  EXPECT_TRUE(read_run(folder.path() / "run").cells.empty());
}

TEST(RunLog, DoesNotReplaceTheResultsOfAnEarlierVersion) {
  const TemporaryFolder folder;
  folder.write("results.csv", "schema_version\n");
  EXPECT_TRUE(
      says(thrown_message([&] { RunLog::create(folder.path()); }), {"already holds a run"}));
}

TEST(RunLog, RefusesAPathWhereNoFolderCanExist) {
  const TemporaryFolder folder;
  const auto file = folder.write("file", "");
  EXPECT_TRUE(says(thrown_message([&] { RunLog::create(file / "run"); }),
                   {"cannot make", "file/run", "-o"}));
}

TEST(RunLog, RefusesToResumeAFolderWithoutARun) {
  const TemporaryFolder folder;
  for (const auto& read : {+[](const std::filesystem::path& path) { read_run(path); },
                           +[](const std::filesystem::path& path) { RunLog::open(path); }}) {
    EXPECT_TRUE(says(thrown_message([&] { read(folder.path()); }),
                     {folder.path().string(), "holds no run", "run.jsonl"}));
  }
}

}  // namespace
}  // namespace beambench::measure
