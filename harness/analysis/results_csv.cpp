#include "harness/analysis/results_csv.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <ostream>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "accel/core/work_counters.hpp"
#include "harness/analysis/standings.hpp"
#include "harness/measure/record/block_statistics.hpp"
#include "harness/measure/record/robust_statistics.hpp"
#include "harness/rays/fingerprint.hpp"
#include "scenes/animation.hpp"
#include "scenes/base/json_text.hpp"

namespace beambench::analysis {
namespace {

using namespace measure;
using Json = nlohmann::ordered_json;

template <class Value>
Json or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json();
}

void add_run(Row& row, const RunFacts& run, const CellRecord& cell) {
  row["schema_version"] = kSchemaVersion;
  row["run_id"] = run.run_id;
  row["time_utc"] = cell.time_utc;
  row["commit"] = run.commit;
  row["dirty"] = run.dirty;
  row["machine_id"] = run.machine_id;
  row["build_type"] = run.build_type;
  row["flags"] = run.flags;
  row["isa"] = run.isa;
  const auto stated = [&](std::string accel::Statistics::*text) {
    const bool known = cell.statistics && !((*cell.statistics).*text).empty();
    return known ? Json((*cell.statistics).*text) : Json();
  };
  row["structure_isa"] = stated(&accel::Statistics::instruction_set);
  row["library_version"] = stated(&accel::Statistics::library_version);
  row["library_geometry"] = stated(&accel::Statistics::library_geometry);
  row["threads"] = run.threads;
}

void add_identity(Row& row, const CellRecord& cell, bool outpaced) {
  row["scene"] = cell.id.scene;
  row["frame"] = or_null(scenes::divide_frame(cell.id.scene).frame);
  row["camera"] = cell.id.camera;
  row["scene_hash"] = rays::hex_digits(cell.rays.scene_hash);
  row["rays_hash"] = rays::hex_digits(cell.rays.rays_hash);
  row["seed"] = cell.rays.seed;
  row["primitives"] = cell.rays.primitives;
  row["structure"] = cell.id.structure;
  row["parameters"] = cell.id.parameters;
  row["width"] = cell.id.resolution.width;
  row["height"] = cell.id.resolution.height;
  row["samples"] = cell.id.samples;
  row["parameter_sets"] = cell.parameter_sets;
  row["outpaced"] = outpaced;
  row["ray_kind"] = cell.id.rays;
  row["order"] = rays::divide_label(cell.id.rays).order;
  row["query"] = rays::to_string(cell.rays.query);
  row["query_path"] = cell.harness ? Json(to_string(cell.harness->path)) : Json();
  row["rays"] = cell.rays.rays;
  row["hit_share"] = or_null(cell.rays.hit_share);
  row["occluded_share"] = or_null(cell.rays.occluded_share);
  row["coherence"] = or_null(cell.rays.coherence);
}

void add_interval(Row& row, const std::string& name, const std::optional<Interval>& interval) {
  row[name + "_low"] = interval ? Json(interval->low) : Json();
  row[name + "_high"] = interval ? Json(interval->high) : Json();
}

/// Adds the two 95% intervals of a figure: for its mean over the blocks, and for the value of a
/// second run. In a record without blocks, adds the interval of its median.
void add_intervals(Row& row, const CellRecord& cell, const std::string& name,
                   const std::function<double(const Repetition&)>& figure,
                   const std::vector<double>& samples) {
  Estimate found{};
  if (!has_blocks(cell)) {
    found.confidence = median_interval(samples);
  } else if (!samples.empty()) {
    std::vector<double> values;
    for (const auto& [block, value] : least_by_block(cell, figure)) values.push_back(value);
    if (!values.empty()) found = estimate(values);
  }
  add_interval(row, name + "_ci", found.confidence);
  add_interval(row, name + "_pi", found.prediction);
}

/// Returns a statistic of samples; null if there are none.
template <class Statistic>
Json statistic(Statistic figure, const std::vector<double>& samples) {
  return samples.empty() ? Json() : Json(figure(samples));
}

void add_wall_time(Row& row, const std::string& phase, const std::vector<double>& samples) {
  row[phase + "_ms_median"] = statistic(median, samples);
  row[phase + "_ms_min"] = statistic(minimum, samples);
  row[phase + "_ms_mad"] = statistic(median_absolute_deviation, samples);
}

/// Adds the time of updates from the first frame; null for structures that were built.
void add_update(Row& row, bool known, const CellRecord& cell) {
  std::vector<double> updates;
  for (const Repetition& one : cell.repetitions) {
    if (known && one.update_ms) updates.push_back(*one.update_ms);
  }
  row["update_ms_median"] = statistic(median, updates);
  row["update_ms_min"] = statistic(minimum, updates);
}

/// Returns the trace time without the harness's share; null if nothing is left. That is the case
/// for `null`, and may be for plug-ins that do not state how they generate rays: they are taken to
/// generate them one by one.
Json net_of_harness(const CellRecord& cell) {
  if (!cell.harness || cell.verdict == verify::Verdict::kBaseline) return {};
  const double net = median(collect(cell, &Repetition::trace_ms)) - cell.harness->ms;
  return net > 0.0 ? Json(net) : Json();
}

/// Adds the number of processes that measured a cell, and the number of repetitions excluded
/// because other processes disturbed them; for a record of one process, adds nothing.
void add_blocks(Row& row, const CellRecord& cell) {
  std::set<int> blocks;
  for (const Repetition& one : cell.repetitions) blocks.insert(one.block);
  row["blocks"] = has_blocks(cell) ? Json(blocks.size()) : Json();
  row["disturbed"] =
      has_blocks(cell)
          ? Json(std::ranges::count_if(cell.repetitions,
                                       [](const Repetition& r) { return !r.is_undisturbed(); }))
          : Json();
}

/// Adds a time used for comparing contenders, with both intervals.
void add_time(Row& row, const std::string& name, const std::optional<Estimate>& time) {
  row[name] = time ? Json(time->value) : Json();
  add_interval(row, name + "_ci", time ? time->confidence : std::nullopt);
  add_interval(row, name + "_pi", time ? time->prediction : std::nullopt);
}

/// Adds the trace time, and the clock used to compare both times.
void add_trace(Row& row, const CellRecord& cell) {
  const auto trace = cell.has_times() ? trace_time(cell) : std::nullopt;
  add_time(row, "trace_ms", trace);
  row["trace_clock"] =
      trace ? Json(has_blocks(cell) && is_disturbed(cell) ? "cpu" : "wall") : Json();
}

void add_times(Row& row, const CellRecord& cell) {
  const bool known = cell.has_times();
  const auto samples = [&](auto figure) {
    return known ? collect(cell, figure) : std::vector<double>();
  };
  const auto median_of = [&](auto figure) { return statistic(median, samples(figure)); };
  row["repetitions"] = cell.repetitions.size();
  add_blocks(row, cell);
  row["stop_reason"] = cell.stop_reason ? Json(to_string(*cell.stop_reason)) : Json();
  add_wall_time(row, "build", samples(&Repetition::build_ms));
  add_update(row, known, cell);
  add_wall_time(row, "trace", samples(&Repetition::trace_ms));
  add_trace(row, cell);
  const std::vector<double> warm = known ? second_traces(cell) : std::vector<double>();
  row["trace_warm_ms_median"] = statistic(median, warm);
  add_intervals(
      row, cell, "trace_warm_ms",
      [](const Repetition& one) { return one.warm_trace_ms.value_or(0.0); }, warm);
  row["harness_ms"] = known && cell.harness ? Json(cell.harness->ms) : Json();
  row["trace_net_ms_median"] = known ? net_of_harness(cell) : Json();
  const std::vector<double> totals = samples(&Repetition::total_ms);
  const std::optional<double> spread = repeat_spread_of_minimum(totals);
  add_wall_time(row, "total", totals);
  add_time(row, "total_ms", known ? total_time(cell) : std::nullopt);
  row["total_ms_min_spread"] = spread ? Json(*spread) : Json();
  const std::vector<double> cycles = samples(&Repetition::total_mcycles);
  row["clock_ghz_median"] = median_of(&Repetition::clock_ghz);
  row["total_mcycles_median"] = median_of(&Repetition::total_mcycles);
  add_intervals(row, cell, "total_mcycles", &Repetition::total_mcycles, cycles);
  row["build_cpu_ms_median"] = median_of(&Repetition::build_cpu_ms);
  row["trace_cpu_ms_median"] = median_of(&Repetition::trace_cpu_ms);
  const auto build = samples(&Repetition::build_ms);
  row["mprimitives_per_s"] =
      !build.empty() && median(build) > 0.0
          ? Json(static_cast<double>(cell.rays.primitives) / (1e3 * median(build)))
          : Json();
  row["mrays_per_s"] = Json();
  if (const auto trace = trace_time(cell); known && trace && trace->value > 0.0) {
    row["mrays_per_s"] = static_cast<double>(cell.rays.rays) / (1e3 * trace->value);
  }
}

/// Returns the median count of an event; null if a repetition lacks it.
Json median_count(const CellRecord& cell, HardwareCounts Repetition::*counts, std::size_t event) {
  std::vector<double> values;
  for (const Repetition& repetition : cell.repetitions) {
    const auto& count = (repetition.*counts)[event];
    if (!count) return {};
    values.push_back(static_cast<double>(*count));
  }
  return std::llround(median(values));
}

void add_hardware_counts(Row& row, const CellRecord& cell) {
  const bool known = cell.has_times();
  const auto add = [&](std::string_view phase, HardwareCounts Repetition::*counts) {
    for (std::size_t event = 0; event < kHardwareEvents.size(); ++event) {
      row[fmt::format("{}_{}", phase, kHardwareEvents[event])] =
          known ? median_count(cell, counts, event) : Json();
    }
  };
  add("build", &Repetition::build_counts);
  add("trace", &Repetition::trace_counts);
}

/// Adds sizes and qualities of the structure. The sizes of the tree are null for structures without
/// nodes: `exhaustive` has no nodes, and Embree does not report any.
void add_statistics(Row& row, const CellRecord& cell) {
  row["memory_bytes"] = cell.statistics ? Json(cell.statistics->bytes) : Json();
  row["allocated_bytes"] = or_null(cell.allocated_bytes);
  row["peak_build_bytes"] = or_null(cell.peak_build_bytes);
  const auto primitives = static_cast<double>(cell.rays.primitives);
  row["bytes_per_primitive"] = cell.statistics && primitives > 0.0
                                   ? Json(static_cast<double>(cell.statistics->bytes) / primitives)
                                   : Json();
  const bool has_nodes = cell.statistics && cell.statistics->nodes > 0;
  const auto size = [&](std::uint64_t accel::Statistics::*member) {
    return has_nodes ? Json((*cell.statistics).*member) : Json();
  };
  row["nodes"] = size(&accel::Statistics::nodes);
  row["leaves"] = size(&accel::Statistics::leaves);
  row["empty_leaves"] = size(&accel::Statistics::empty_leaves);
  row["references"] = size(&accel::Statistics::references);
  row["depth"] = size(&accel::Statistics::depth);
  row["tree_cost"] = cell.statistics ? or_null(cell.statistics->figure("cost")) : Json();
  for (const char* name : {"sah_nodes", "sah_leaves", "sah_tests", "sah_cost", "epo"}) {
    row[name] = cell.statistics ? or_null(cell.statistics->figure(name)) : Json();
  }
}

void add_counters(Row& row, const CellRecord& cell) {
  const NamedCounters& counters = cell.work.counters;
  const auto rays = static_cast<double>(cell.rays.rays);
  const auto add = [&](std::string_view name) {
    const auto found = counters.find(name);
    row[fmt::format("{}_per_ray", name)] =
        found == counters.end() ? Json() : Json(static_cast<double>(found->second) / rays);
  };
  std::ranges::for_each(accel::kCounterNames, add);
  std::ranges::for_each(accel::kTestNames, add);
  for (const auto& [name, count] : counters) {
    row[name + "_per_ray"] = static_cast<double>(count) / rays;
  }
}

/// Adds the columns of whole pictures: `shadow_rays`, and `shadow_box_tests_per_ray` of the shadow
/// rays alone. A family's own counters are not split by kind: most of them count beams, which only
/// camera rays have.
void add_kinds(Row& row, const CellRecord& cell) {
  for (const RaysOfKind& kind : cell.work.kinds) {
    row[kind.kind + "_rays"] = kind.rays;
    if (cell.work.counters.empty() || kind.rays == 0) continue;
    const auto add = [&](std::string_view name) {
      const auto count = kind.counters.find(name);
      if (count == kind.counters.end()) return;
      row[fmt::format("{}_{}_per_ray", kind.kind, name)] =
          static_cast<double>(count->second) / static_cast<double>(kind.rays);
    };
    std::ranges::for_each(accel::kCounterNames, add);
    std::ranges::for_each(accel::kTestNames, add);
  }
}

void add_verification(Row& row, const CellRecord& cell) {
  row["hits"] = cell.diff ? Json(cell.diff->hits) : Json();
  for (std::size_t i = 0; i < verify::kRecordedClassNames.size(); ++i) {
    row[std::string(verify::kRecordedClassNames[i])] =
        cell.diff ? Json(cell.diff->counts[i]) : Json();
  }
  row["verdict"] = verify::to_string(cell.verdict);
}

using Columns = std::vector<std::string>;

/// Adds the columns of `row` that `columns` lacks, each after its predecessor in `row`.
void merge_columns(Columns& columns, const Row& row) {
  auto place = columns.begin();
  for (const auto& [name, value] : row.items()) {
    const auto found = std::find(columns.begin(), columns.end(), name);
    place = (found == columns.end() ? columns.insert(place, name) : found) + 1;
  }
}

/// Returns a value as a CSV field.
std::string field_of(const Row& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return csv_field(value.get<std::string>());
  if (value.is_number_float()) return fmt::format("{}", value.get<double>());
  return json_text(value, -1);
}

std::string csv_line(const std::vector<std::string>& fields) {
  return fmt::format("{}\n", fmt::join(fields, ","));
}

std::string csv_header(const Columns& columns) {
  std::vector<std::string> fields;
  fields.reserve(columns.size());
  for (const std::string& column : columns) fields.push_back(csv_field(column));
  return csv_line(fields);
}

std::string csv_line(const Columns& columns, const Row& row) {
  std::vector<std::string> fields;
  fields.reserve(columns.size());
  for (const std::string& column : columns) {
    const auto found = row.find(column);
    fields.push_back(found == row.end() ? std::string() : field_of(*found));
  }
  return csv_line(fields);
}

/// Writes the header and the rows. Calls `row` twice for each row, because all rows together take
/// far more memory than the cells that they describe.
void write_table(std::ostream& out, std::size_t count, const std::function<Row(std::size_t)>& row) {
  Columns columns;
  for (std::size_t i = 0; i < count; ++i) merge_columns(columns, row(i));
  out << csv_header(columns);
  for (std::size_t i = 0; i < count; ++i) out << csv_line(columns, row(i));
}

}  // namespace

RunFacts facts_of(const Json& manifest) {
  const Json& program = manifest.at("program");
  const Json& measurement = manifest.at("measurement");
  return {manifest.at("run_id").get<std::string>(),
          program.at("commit").get<std::string>(),
          program.at("dirty").get<bool>(),
          manifest.at("machine").at("id").get<std::string>(),
          program.at("build_type").get<std::string>(),
          program.at("flags").get<std::string>(),
          measurement.at("isa").is_string() ? measurement.at("isa").get<std::string>() : "",
          measurement.at("threads").get<int>()};
}

std::map<int, RunFacts> facts_by_shard(const Json& manifest) {
  std::map<int, RunFacts> facts{{0, facts_of(manifest)}};
  for (const Json& shard : manifest.value("shards", Json::array())) {
    RunFacts& own = facts[shard.at("number").get<int>()] = facts.at(0);
    own.machine_id = shard.at("machine").at("id").get<std::string>();
    own.isa = shard.at("measurement").at("isa").get<std::string>();
  }
  return facts;
}

Row to_row(const RunFacts& run, const CellRecord& cell, bool outpaced) {
  Row row = Row::object();
  add_run(row, run, cell);
  add_identity(row, cell, outpaced);
  add_times(row, cell);
  add_hardware_counts(row, cell);
  add_statistics(row, cell);
  add_counters(row, cell);
  add_kinds(row, cell);
  add_verification(row, cell);
  for (const auto& [column, figure] : cell.columns) row[column] = figure;
  return row;
}

std::string csv_field(std::string_view text) {
  constexpr std::string_view kFormulaOrApostrophe = "=+-@\t\r'";
  std::string guarded(text);
  if (!text.empty() && kFormulaOrApostrophe.find(text.front()) != std::string_view::npos) {
    guarded.insert(0, 1, '\'');
  }
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return guarded;
  std::string field = "\"";
  for (const char letter : guarded) {
    if (letter == '"') field += '"';
    field += letter;
  }
  return field + '"';
}

std::string csv_table(std::span<const Row> rows) {
  std::ostringstream out;
  write_table(out, rows.size(), [&](std::size_t i) { return rows[i]; });
  return out.str();
}

void write_results(std::ostream& out, const Run& run) {
  const std::map<int, RunFacts> facts = facts_by_shard(run.manifest);
  const std::set<std::size_t> outpaced = outpaced_sets(run);
  write_table(out, run.cells.size(), [&](std::size_t i) {
    const CellRecord& cell = run.cells[i];
    return to_row(facts.at(cell.shard), cell, outpaced.contains(cell.index));
  });
}

}  // namespace beambench::analysis
