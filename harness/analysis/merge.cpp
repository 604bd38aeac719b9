#include "harness/analysis/merge.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "harness/analysis/exports.hpp"
#include "harness/analysis/results_csv.hpp"
#include "harness/base/messages.hpp"
#include "harness/measure/record/conditions.hpp"
#include "harness/measure/record/joined_manifest.hpp"
#include "harness/measure/record/run_log.hpp"
#include "harness/measure/record/shard.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/files.hpp"
#include "scenes/base/json_text.hpp"
#include "scenes/base/shell_word.hpp"

namespace beambench::analysis {
namespace {

using measure::CellRecord;
using measure::Run;
using measure::RunLog;
using measure::Shard;
using measure::ShardFacts;

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A folder that contains a shard.
struct ShardFolder {
  RunLog log;  ///< locks the folder against other processes
  Run run;
  ShardFacts facts;

  std::string path() const { return log.folder().string(); }
  std::string file() const { return (log.folder() / measure::kLogName).string(); }
};

[[noreturn]] void refuse(const std::string& reason) { throw InputError("cannot merge: " + reason); }

void require_different(std::span<const fs::path> folders) {
  for (std::size_t i = 0; i < folders.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      std::error_code unknown;
      if (!fs::equivalent(folders[i], folders[j], unknown)) continue;
      refuse(fmt::format("'{}' and '{}' are the same folder; pass each shard once",
                         folders[j].string(), folders[i].string()));
    }
  }
}

ShardFolder read_shard(const fs::path& path) {
  const std::string remedy = "pass the folders written by 'beambench run --shard K/N -o DIR'";
  if (!fs::exists(path / measure::kLogName)) {
    refuse(fmt::format("'{}' holds no run: there is no {}; {}", path.string(), measure::kLogName,
                       remedy));
  }
  RunLog log = RunLog::open(path);
  Run run = measure::read_run(path);
  const auto facts = read_as_written((path / measure::kLogName).string(), "measure the shard again",
                                     [&] { return measure::shard_of_manifest(run.manifest); });
  if (!facts) {
    refuse(fmt::format("'{}' holds no shard but {}; {}", path.string(),
                       measure::is_merged(run.manifest) ? "a run that was merged" : "a whole run",
                       remedy));
  }
  return {std::move(log), std::move(run), *facts};
}

void require_one_sweep(const ShardFolder& first, const ShardFolder& other) {
  const nlohmann::json changes = nlohmann::json::diff(first.run.config, other.run.config);
  if (!changes.empty()) {
    refuse(fmt::format(
        "'{}' and '{}' belong to two sweeps, which differ at {}; merge the shards of one sweep",
        first.path(), other.path(), changes.front().at("path").get<std::string>()));
  }
  const std::string difference = read_as_written(other.file(), "measure the shard again", [&] {
    return measure::program_difference(first.run.manifest, other.run.manifest);
  });
  if (!difference.empty()) {
    refuse(fmt::format("'{}' and '{}': {}; measure one of them again", first.path(), other.path(),
                       difference));
  }
  if (first.facts.shard.count != other.facts.shard.count ||
      first.facts.cells_of_sweep != other.facts.cells_of_sweep) {
    refuse(fmt::format(
        "'{}' is shard {} of {}, and '{}' is shard {} of {}; merge the shards of "
        "one division",
        first.path(), to_string(first.facts.shard),
        base::counted(first.facts.cells_of_sweep, "cell"), other.path(),
        to_string(other.facts.shard), base::counted(other.facts.cells_of_sweep, "cell")));
  }
}

/// Returns whether the same program always measures the same value of a column.
bool is_repeatable(std::string_view column) {
  if (column.ends_with("_per_ray")) return !column.ends_with("_ns_per_ray");
  return column.ends_with("_rays") || column == "rays" || column == "rays_hash" ||
         column == "scene_hash" || column == "hits";
}

[[noreturn]] void refuse_doubled(const ShardFolder& first, const ShardFolder& second) {
  refuse(fmt::format("shard {} appears twice, in '{}' and in '{}'; leave one of them out",
                     to_string(first.facts.shard), first.path(), second.path()));
}

/// Refuses two folders that share a cell, stating the most informative reason.
[[noreturn]] void refuse_overlap(const ShardFolder& first, const ShardFolder& second) {
  std::map<std::string, Json> rows;  // rows of the second, by cell name
  for (const CellRecord& cell : second.run.cells) {
    rows[cell.id.name()] = to_row(facts_of(second.run.manifest), cell);
  }
  std::string shared;
  for (const CellRecord& cell : first.run.cells) {
    const auto found = rows.find(cell.id.name());
    if (found == rows.end()) continue;
    shared = cell.id.name();
    const Row row = to_row(facts_of(first.run.manifest), cell);
    for (const auto& [column, value] : row.items()) {
      const Json other = found->second.value(column, Json());
      if (!is_repeatable(column) || value == other) continue;
      refuse(fmt::format(
          "the cell {} has {} {} in '{}' and {} in '{}'; counters repeat, so one of the records is "
          "damaged: measure both shards again",
          shared, column, json_text(value, -1), first.path(), json_text(other, -1), second.path()));
    }
  }
  if (first.facts.shard == second.facts.shard) refuse_doubled(first, second);
  refuse(
      fmt::format("the cell {} is in '{}' and in '{}', so the sweep was not divided in the same "
                  "way; measure both shards again",
                  shared, first.path(), second.path()));
}

void require_each_cell_once(const std::vector<ShardFolder>& shards) {
  std::map<std::string, const ShardFolder*> places;  // the folders of cells, by cell name
  for (const ShardFolder& shard : shards) {
    for (const CellRecord& cell : shard.run.cells) {
      const auto [place, is_new] = places.emplace(cell.id.name(), &shard);
      if (!is_new) refuse_overlap(*place->second, shard);
    }
  }
}

void require_finished(const ShardFolder& shard) {
  const auto finished =
      static_cast<std::size_t>(std::ranges::count_if(shard.run.cells, &CellRecord::is_finished));
  const std::size_t wanted = shard.facts.cells - shard.run.passed_over.size();
  if (shard.run.is_ended() && finished == wanted) return;
  refuse(fmt::format("shard {} in '{}' has {} of {}; finish it with: beambench run --resume {}",
                     to_string(shard.facts.shard), shard.path(), finished,
                     base::counted(wanted, "cell"), shell_quoted(shard.path())));
}

/// Refuses a manifest that was modified after the run, before anything is written.
void require_intact(const ShardFolder& shard) {
  read_as_written(shard.file(), "measure the shard again", [&] {
    const Json joined = measure::joined_manifest(std::span(&shard.run.manifest, 1));
    measure::conditions_of(joined);
    facts_of(joined);
  });
}

/// The shards, ordered by number.
using InOrder = std::vector<const ShardFolder*>;

/// Refuses a division in which a shard is missing or appears twice.
InOrder require_all(const std::vector<ShardFolder>& shards) {
  std::map<int, const ShardFolder*> by_number;
  for (const ShardFolder& shard : shards) {
    const auto [found, is_new] = by_number.emplace(shard.facts.shard.number, &shard);
    if (!is_new) refuse_doubled(*found->second, shard);
  }
  const int count = shards.front().facts.shard.count;
  InOrder in_order;
  std::vector<std::string> missing;
  for (int number = 1; number <= count; ++number) {
    if (by_number.contains(number)) {
      in_order.push_back(by_number.at(number));
    } else {
      missing.push_back(to_string(Shard{number, count}));
    }
  }
  if (missing.empty()) return in_order;
  refuse(
      fmt::format("{} of the sweep {} missing: {}; pass all folders, or measure it with: beambench "
                  "run SWEEP --shard {} -o DIR",
                  missing.size() == 1 ? "a shard" : "shards",
                  fmt::format("'{}' {}", shards.front().run.config.value("name", ""),
                              missing.size() == 1 ? "is" : "are"),
                  fmt::join(missing, ", "), missing.front()));
}

/// A temporary folder beside its final place. It is removed unless it has been moved to that place.
class FolderAside {
 public:
  explicit FolderAside(const fs::path& target) : target_(target) {
    const fs::path parent = target.has_parent_path() ? target.parent_path() : fs::path(".");
    make_folder(parent, "choose another with -o");
    const std::string prefix = fmt::format(".{}.partial-", target.filename().string());
    path_ = parent / (prefix + std::to_string(::getpid()));
    for (const auto& entry : fs::directory_iterator(parent)) {
      if (entry.path().filename().string().starts_with(prefix)) remove_abandoned(entry.path());
    }
  }
  FolderAside(const FolderAside&) = delete;
  FolderAside& operator=(const FolderAside&) = delete;
  ~FolderAside() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }

  const fs::path& path() const { return path_; }

  void put_in_place() {
    std::error_code error;
    fs::rename(path_, target_, error);
    if (error) {
      throw InputError(fmt::format("cannot write the folder '{}': {}; choose another with -o",
                                   target_.string(), error.message()));
    }
    path_.clear();
  }

 private:
  /// Removes the leftovers of a killed process, unless another process is working in them.
  static void remove_abandoned(const fs::path& folder) {
    try {
      const FolderLock lock(folder);
      std::error_code ignored;
      fs::remove_all(folder, ignored);
    } catch (const InputError&) {  // another process is
    }
  }

  fs::path target_;
  fs::path path_;
};

/// Copies the events of cells and of tuning from a shard's log.
void copy_cells(const ShardFolder& shard, RunLog& log) {
  measure::for_each_event(shard.log.folder(), [&](Json event) {
    if (!event.contains("index") && event.at("event") != "tuning") return;
    if (event.at("event") == "cell") event["shard"] = shard.facts.shard.number;
    log.add(event);
  });
}

/// Writes the log of a run of the whole sweep.
void write_log(const InOrder& shards, const fs::path& path) {
  std::vector<Json> manifests;
  std::vector<measure::PlannedName> plan;
  for (const ShardFolder* shard : shards) {
    manifests.push_back(shard->run.manifest);
    plan.insert(plan.end(), shard->run.plan.begin(), shard->run.plan.end());
    plan.insert(plan.end(), shard->run.passed_over.begin(), shard->run.passed_over.end());
  }
  const std::size_t wanted = shards.front()->facts.cells_of_sweep;
  if (plan.size() != wanted) {
    refuse(
        fmt::format("the shards have {} of {}, so the sweep was not divided in the same way; "
                    "measure all shards again",
                    plan.size(), base::counted(wanted, "cell")));
  }
  std::ranges::sort(plan, {}, &measure::PlannedName::index);
  const Json manifest = measure::joined_manifest(manifests);
  RunLog log = RunLog::create(path);
  log.begin(manifest, shards.front()->run.config, plan);
  for (const ShardFolder* shard : shards) copy_cells(*shard, log);
  log.end(manifest.at("finished_utc").get<std::string>());
}

Analysis merge_into(const fs::path& target, std::span<const fs::path> folders,
                    std::FILE* messages) {
  std::vector<ShardFolder> shards;
  for (const fs::path& folder : folders) {
    shards.push_back(read_shard(folder));
    require_one_sweep(shards.front(), shards.back());
  }
  require_each_cell_once(shards);
  std::ranges::for_each(shards, require_finished);
  std::ranges::for_each(shards, require_intact);
  const InOrder in_order = require_all(shards);
  for (const ShardFolder* shard : in_order) {
    fmt::print(messages, "shard {}: {}, machine {}, '{}'\n", to_string(shard->facts.shard),
               base::counted(shard->facts.cells, "cell"),
               shard->run.manifest.at("machine").at("id").get<std::string>(), shard->path());
  }
  FolderAside aside(target);
  write_log(in_order, aside.path());
  Analysis analysis = conclude(aside.path());
  aside.put_in_place();
  return analysis;
}

}  // namespace

Analysis merge_shards(std::span<const fs::path> folders, const fs::path& output,
                      std::FILE* messages) {
  fs::path target = output.lexically_normal();
  if (target.filename().empty()) target = target.parent_path();
  if (fs::exists(fs::symlink_status(target))) {
    refuse(fmt::format("'{}' already exists; choose another folder with -o", target.string()));
  }
  require_different(folders);
  return read_as_written("a shard", "measure it again",
                         [&] { return merge_into(target, folders, messages); });
}

}  // namespace beambench::analysis
