#include "harness/measure/record/run_log.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <memory>
#include <set>
#include <system_error>

#include <fmt/format.h>
#include <zlib.h>

#include "harness/measure/record/conditions.hpp"
#include "harness/measure/record/shard.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/json_text.hpp"
#include "scenes/base/printable.hpp"
#include "scenes/base/shell_word.hpp"

namespace beambench::measure {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::string_view kRemedy = "begin a new run with -o";

void remove_left_behind(const fs::path& folder) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (is_left_behind(entry.path())) fs::remove(entry.path(), ignored);
  }
}

/// Calls `visit` with each whole line; returns the total size of these lines in bytes.
std::uint64_t for_each_line(const fs::path& log,
                            const std::function<void(std::string_view line)>& visit) {
  InputStream input(log);
  std::uint64_t whole = 0;
  while (const auto line = input.line()) {
    if (input.position() == whole + line->size()) break;  // no line end: it was cut off
    visit(*line);
    whole = input.position();
  }
  return whole;
}

/// Does what `for_each_line` does for a log compressed with gzip.
std::uint64_t for_each_packed_line(const fs::path& log,
                                   const std::function<void(std::string_view line)>& visit) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(log.c_str(), "rb"), gzclose);
  std::array<char, 1U << 16U> buffer;
  std::string pending;
  std::uint64_t whole = 0;
  for (int count = 1; count != 0;) {
    count = file ? gzread(file.get(), buffer.data(), buffer.size()) : -1;
    if (count < 0) throw InputError(fmt::format("{}: cannot be decompressed", log.string()));
    pending.append(buffer.data(), static_cast<std::size_t>(count));
    std::size_t begin = 0;
    for (std::size_t end; (end = pending.find('\n', begin)) != std::string::npos; begin = end + 1) {
      visit(std::string_view(pending).substr(begin, end - begin));
    }
    pending.erase(0, begin);
    whole += begin;
  }
  return whole;
}

/// Returns the path of the log in a folder, compressed or not.
fs::path log_in(const fs::path& folder) {
  const fs::path log = folder / kLogName;
  const fs::path packed = folder / kPackedLogName;
  return !fs::exists(log) && fs::exists(packed) ? packed : log;
}

Json with_other_work(Json event, std::optional<double> processors) {
  if (processors) event["other_work"] = *processors;
  return event;
}

/// Adds the events of a log to the run being read.
class Reader {
 public:
  void take(const Json& event) {
    const auto& kind = event.at("event").get_ref<const std::string&>();
    if (kind == "header") return begin(event);
    if (run_.manifest.is_null()) throw InputError("the log does not begin with its header");
    if (kind == "resumed") {
      run_.manifest = event.at("manifest");
    } else if (is_of_cell(kind)) {
      apply(event, cell_of(event));
    } else if (kind == "tuning") {
      pass_over(event);
    } else if (kind == "block") {
      read_other_work(event);
    } else if (kind == "warning") {
      run_.manifest.at("uncontrolled").push_back(event.at("text"));
    } else if (kind == "throttling") {
      run_.manifest.at("measurement")["throttling"] = event.at("throttling");
    } else if (kind == "end") {
      run_.manifest["finished_utc"] = event.at("time_utc");
      read_other_work(event);
    } else {
      throw InputError(fmt::format("'{}' is not an event that this version supports", kind));
    }
  }

  Run result() && {
    for (auto& [index, cell] : cells_) {
      if (cell.is_finished || cell.diff) run_.cells.push_back(std::move(cell));
    }
    return std::move(run_);
  }

 private:
  /// Keeps the latest mean; of older logs, the highest load average.
  void read_other_work(const Json& event) {
    if (event.contains("other_work")) {
      run_.manifest.at("measurement")["other_work"] = event.at("other_work");
    }
    if (!event.contains("load")) return;
    Json& highest = run_.manifest.at("measurement")["highest_load"];
    const double load = event.at("load").get<double>();
    if (!highest.is_number() || highest.get<double>() < load) highest = load;
  }

  void begin(const Json& event) {
    if (!run_.manifest.is_null()) throw InputError("the log has a second header");
    if (const int version = event.at("schema_version").get<int>();
        version < 1 || version > kLogVersion) {
      throw InputError(fmt::format("it has version {}, but this beambench reads versions 1 to {}",
                                   version, kLogVersion));
    }
    run_.manifest = event.at("manifest");
    run_.config = event.at("config");
    for (const Json& planned : event.at("plan")) {
      run_.plan.push_back({planned.at(0).get<std::size_t>(), planned.at(1).get<std::string>()});
    }
  }

  /// Moves the cells that tuning tried but did not keep from the plan to `passed_over`.
  void pass_over(const Json& event) {
    std::set<std::size_t> others;
    for (const Json& each : event.at("candidates"))
      others.insert(each.at("index").get<std::size_t>());
    for (const Json& index : event.at("kept")) others.erase(index.get<std::size_t>());
    const auto is_other = [&](const PlannedName& cell) { return others.contains(cell.index); };
    std::ranges::copy_if(run_.plan, std::back_inserter(run_.passed_over), is_other);
    std::erase_if(run_.plan, is_other);
  }

  CellRecord& cell_of(const Json& event) {
    const auto index = event.at("index").get<std::size_t>();
    CellRecord& cell = cells_[index];
    cell.index = index;
    return cell;
  }

  Run run_;
  std::map<std::size_t, CellRecord> cells_;
};

/// Throws InputError if a cell belongs to a shard that is not in the manifest.
void require_known_shards(const Run& run, const std::string& log) {
  std::set<int> known{0};
  for (const Json& shard : run.manifest.value("shards", Json::array())) {
    known.insert(shard.at("number").get<int>());
  }
  for (const CellRecord& cell : run.cells) {
    if (known.contains(cell.shard)) continue;
    throw InputError(
        fmt::format("{}: cell {} belongs to shard {}, which is not in the manifest; {}", log,
                    cell.index, cell.shard, kRemedy));
  }
}

/// Returns a member of a manifest as a string, whatever its type; empty if it is missing.
std::string member(const Json& manifest, const char* pointer) {
  const Json::json_pointer place(pointer);
  return manifest.contains(place) ? json_text(manifest.at(place), -1) : "";
}

/// Returns the hashes of a manifest's plug-ins or scenes, keyed by file or name.
std::map<std::string, std::string> hashes(const Json& manifest, const char* list, const char* key) {
  std::map<std::string, std::string> found;
  for (const Json& each : manifest.value(list, Json::array())) {
    found[each.at(key).get<std::string>()] = each.at("hash").get<std::string>();
  }
  return found;
}

/// Throws InputError if a folder contains anything except hidden files, a lock and leftovers of a
/// killed process: each run needs its own folder.
void require_empty(const fs::path& folder) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().filename().string().starts_with('.') || is_left_behind(entry.path())) continue;
    throw InputError(
        fmt::format("'{}' is not empty: it contains '{}'; choose a new folder with -o, or empty it",
                    folder.string(), entry.path().filename().string()));
  }
}

}  // namespace

std::uint64_t for_each_event(const fs::path& folder,
                             const std::function<void(const Json&)>& visit) {
  const fs::path log = log_in(folder);
  std::size_t number = 0;
  const auto visit_line = [&](std::string_view line) {
    const std::string place = fmt::format("{}, line {}", log.string(), ++number);
    const Json event = parse_json<Json>(line, place);
    try {
      read_as_written(place, kRemedy, [&] { visit(event); });
    } catch (const InputError& error) {
      const std::string message = error.what();
      if (message.starts_with(log.string())) throw;
      throw InputError(fmt::format("{}: {}; {}", place, message, kRemedy));
    }
  };
  return log.filename() == kPackedLogName ? for_each_packed_line(log, visit_line)
                                          : for_each_line(log, visit_line);
}

Run read_run(const fs::path& folder) {
  require_run(folder);
  const std::string log = log_in(folder).string();
  Reader reader;
  const std::uint64_t bytes = for_each_event(folder, [&](const Json& e) { reader.take(e); });
  Run run = std::move(reader).result();
  run.log_bytes = bytes;
  if (run.manifest.is_null()) {
    throw InputError(fmt::format("{}: it does not contain a whole line; {}", log, kRemedy));
  }
  read_as_written(log, kRemedy, [&] { require_known_shards(run, log); });
  return run;
}

void require_run(const fs::path& folder) {
  if (fs::exists(log_in(folder))) return;
  throw InputError(fmt::format("'{}' holds no run: there is no {}; begin one with -o",
                               folder.string(), kLogName));
}

RunLog RunLog::create(const fs::path& folder) {
  make_folder(folder, "choose another with -o");
  RunLog log(folder);
  if (fs::exists(folder / kLogName) || fs::exists(folder / "results.csv")) {
    throw InputError(
        fmt::format("'{}' already holds a run; resume it with --resume '{}', or "
                    "choose another folder with -o",
                    folder.string(), folder.string()));
  }
  require_empty(folder);
  remove_left_behind(folder);
  return log;
}

RunLog RunLog::open(const fs::path& folder) {
  require_run(folder);
  RunLog log(folder);
  remove_left_behind(folder);
  return log;
}

void RunLog::begin(const Json& manifest, const nlohmann::json& config,
                   std::span<const PlannedName> plan) {
  Json names = Json::array();
  for (const PlannedName& cell : plan) names.push_back(Json::array({cell.index, cell.name}));
  const Json header{{"event", "header"},
                    {"schema_version", kLogVersion},
                    {"manifest", manifest},
                    {"config", config},
                    {"plan", names}};
  const std::string line = json_text(header, -1) + '\n';
  write_file(folder_ / kLogName, line);
  file_.emplace(folder_ / kLogName, line.size());
}

void RunLog::resume(const Json& manifest, std::uint64_t log_bytes) {
  file_.emplace(folder_ / kLogName, log_bytes);
  add({{"event", "resumed"}, {"manifest", manifest}});
}

void RunLog::begin_block(const std::string& view, int block, std::optional<double> other_work) {
  add(with_other_work({{"event", "block"}, {"view", view}, {"block", block}}, other_work));
}

void RunLog::set_throttling(const Throttling& throttling) {
  add({{"event", "throttling"}, {"throttling", to_json(std::optional(throttling))}});
}

void RunLog::end(const std::string& time_utc, std::optional<double> other_work) {
  add(with_other_work({{"event", "end"}, {"time_utc", time_utc}}, other_work));
}

void RunLog::add(const Json& event) { file_.value().add_line(json_text(event, -1)); }

std::string program_difference(const Json& first, const Json& second) {
  const auto differs = [&](const char* pointer) {
    return member(first, pointer) != member(second, pointer);
  };
  if (differs("/program/commit")) {
    return fmt::format("one was made by beambench of commit {}, the other by {}",
                       member(first, "/program/commit"), member(second, "/program/commit"));
  }
  if (differs("/program/executable_hash")) {
    return "they were made by two builds of beambench with different sources or options";
  }
  if (hashes(first, "plugins", "file") != hashes(second, "plugins", "file")) {
    return "they were run with different plug-ins";
  }
  const auto scenes = hashes(first, "scenes", "name");
  for (const auto& [name, hash] : hashes(second, "scenes", "name")) {
    const auto found = scenes.find(name);
    if (found != scenes.end() && found->second != hash) {
      return fmt::format("the scene {} differs (scene hashes {} and {})", json_text(Json(name), -1),
                         found->second, hash);
    }
  }
  return "";
}

namespace {

/// Returns why the run cannot be resumed; empty if it can be.
std::string other_run(const Run& run, const nlohmann::json& config, const Json& now) {
  const Json& then = run.manifest;
  const auto differs = [&](const char* pointer) {
    return member(then, pointer) != member(now, pointer);
  };
  if (const auto changes = nlohmann::json::diff(run.config, config); !changes.empty()) {
    return fmt::format("the configuration has changed at {}",
                       changes.front().at("path").get<std::string>());
  }
  if (differs("/program/commit")) {
    return fmt::format("it was begun by beambench of commit {}; this is commit {}",
                       member(then, "/program/commit"), member(now, "/program/commit"));
  }
  if (differs("/program/executable_hash")) {
    return "it was begun by a build of beambench with different sources or options";
  }
  if (is_merged(then)) return "it was merged from the shards of a sweep, so it is complete";
  if (differs("/machine/id")) return "it was begun on another machine";
  const auto plugins = hashes(now, "plugins", "file");
  for (const auto& [file, hash] : hashes(then, "plugins", "file")) {
    const auto found = plugins.find(file);
    if (found == plugins.end()) {
      return fmt::format("it was begun with --plugin {}", shell_quoted(path_of_name(file)));
    }
    if (found->second != hash) return fmt::format("the plug-in {} has changed since", file);
  }
  const auto earlier = hashes(then, "scenes", "name");
  for (const auto& [name, hash] : hashes(now, "scenes", "name")) {
    const auto found = earlier.find(name);
    if (found != earlier.end() && found->second != hash) {
      return fmt::format("the scene {} has changed since", json_text(Json(name), -1));
    }
  }
  return "";
}

}  // namespace

void require_same_run(const fs::path& folder, const Run& run, const nlohmann::json& config,
                      const Json& manifest) {
  const std::string reason = read_as_written((folder / kLogName).string(), kRemedy,
                                             [&] { return other_run(run, config, manifest); });
  if (reason.empty()) return;
  throw InputError(fmt::format("cannot resume '{}': {}; {}", folder.string(), reason, kRemedy));
}

}  // namespace beambench::measure
