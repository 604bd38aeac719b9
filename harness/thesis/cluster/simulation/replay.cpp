#include "harness/thesis/cluster/simulation/replay.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "scenes/base/error.hpp"
#include "scenes/base/files.hpp"

namespace beambench::cluster {
namespace {

constexpr std::string_view kRemedy = "'beambench-cluster SCENE --tasks FILE.csv' writes such files";
constexpr const char* kEstimate = "estimate_seconds";
constexpr std::string_view kEnd = "end";  // the name of the row after the last task

std::vector<std::string> split(std::string_view line) {
  std::vector<std::string> fields(1);
  for (const char c : line) {
    if (c == '\r') continue;
    if (c == ',') {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  return fields;
}

/// A line of the table: its fields by column name.
class Line {
 public:
  Line(const std::filesystem::path& path, std::map<std::string, std::size_t> columns)
      : path_(path), columns_(std::move(columns)) {
    for (const char* name : {"task", "walk_seconds", "work_seconds", "accept_seconds", "task_bytes",
                             "result_bytes", "samples"}) {
      if (!columns_.contains(name)) fail(fmt::format("there is no column '{}'; {}", name, kRemedy));
    }
  }

  void read(std::string_view text) {
    ++number_;
    fields_ = split(text);
    if (fields_.size() != columns_.size()) {
      fail(fmt::format("{} fields, but the first line has {}", fields_.size(), columns_.size()));
    }
  }

  bool has(const char* column) const { return columns_.contains(column); }
  const std::string& text(const char* column) const { return fields_[columns_.at(column)]; }
  double number(const char* column) const {
    const std::string& field = text(column);
    double value = 0.0;
    const char* end = field.data() + field.size();
    const auto [stop, error] = std::from_chars(field.data(), end, value);
    if (error != std::errc() || stop != end || !std::isfinite(value) || value < 0.0) {
      fail(fmt::format("{} is '{}'; expected a number that is not negative", column, field));
    }
    return value;
  }
  std::size_t count(const char* column) const { return static_cast<std::size_t>(number(column)); }

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", path_.string(), number_, what));
  }

 private:
  std::filesystem::path path_;
  std::map<std::string, std::size_t> columns_;
  std::size_t number_ = 1;
  std::vector<std::string> fields_;
};

template <class Value>
double sum(const std::vector<TaskCost>& tasks, Value value) {
  double total = 0.0;
  for (const TaskCost& task : tasks) total += task.*value;
  return total;
}

std::string read_tasks(const std::filesystem::path& path) {
  try {
    return read_text_input(path, kLargestFile);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}; {}", error.what(), kRemedy));
  }
}

using Number = std::uint32_t;

/// Writes the number of a task, padded to the size of the real message.
void put(Number number, std::size_t size, Bytes& bytes) {
  const std::size_t begin = bytes.size();
  ByteWriter(bytes).put(number);
  bytes.resize(begin + std::max(size, sizeof number));
}

Number number_in(std::span<const std::byte> bytes, const TaskCosts& costs) {
  const auto number = ByteReader(bytes).get<Number>();
  if (number >= costs.tasks.size()) throw ProtocolError("a message has an unknown task number");
  return number;
}

}  // namespace

double TaskCosts::walk_seconds() const {
  return sum(tasks, &TaskCost::walk_seconds) + last_walk_seconds;
}
double TaskCosts::work_seconds() const { return sum(tasks, &TaskCost::work_seconds); }
double TaskCosts::accept_seconds() const { return sum(tasks, &TaskCost::accept_seconds); }

TaskCosts read_task_costs(const std::filesystem::path& path) {
  std::istringstream file(read_tasks(path));
  std::string text;
  if (!std::getline(file, text)) {
    throw InputError(fmt::format("cannot read tasks from '{}'; {}", path.string(), kRemedy));
  }
  std::map<std::string, std::size_t> columns;
  for (const std::string& name : split(text)) columns.emplace(name, columns.size());
  Line line(path, std::move(columns));
  TaskCosts costs;
  bool ended = false;
  while (std::getline(file, text)) {
    line.read(text);
    if (ended) line.fail("there is a task after the row 'end'");
    ended = line.text("task") == kEnd;
    if (ended) {
      costs.last_walk_seconds = line.number("walk_seconds");
    } else {
      costs.tasks.push_back({line.number("walk_seconds"), line.number("work_seconds"),
                             line.number("accept_seconds"), line.count("task_bytes"),
                             line.count("result_bytes"), line.count("samples"),
                             line.has(kEstimate) ? line.number(kEstimate) : 0.0});
    }
  }
  if (!ended) line.fail("the file ends before the row 'end': it was cut off");
  if (costs.tasks.empty()) line.fail("there is no task");
  return costs;
}

TaskCosts slowed(TaskCosts costs, double walk, double work) {
  for (TaskCost& task : costs.tasks) {
    task.walk_seconds *= walk;
    task.work_seconds *= work;
    task.accept_seconds *= work;
  }
  costs.last_walk_seconds *= walk;
  return costs;
}

TaskCosts with_results_of(double bytes_per_sample, TaskCosts costs) {
  for (TaskCost& task : costs.tasks) {
    task.result_bytes =
        static_cast<std::size_t>(std::ceil(bytes_per_sample * static_cast<double>(task.samples)));
  }
  return costs;
}

std::vector<Share> planned(ImageDivision division, const TaskCosts& costs, int consumers) {
  std::vector<double> estimates;
  for (const TaskCost& task : costs.tasks) estimates.push_back(task.estimate_seconds);
  if (division == ImageDivision::kEqualCost &&
      std::ranges::none_of(estimates, [](double seconds) { return seconds > 0.0; })) {
    throw InputError("these tasks have no cost estimates; record them with --work pre-pass");
  }
  return divide(division, costs.tasks.size(), {consumers, 1, estimates});
}

TaskCosts merged(const TaskCosts& costs, const std::vector<Share>& shares, bool stored) {
  TaskCosts merged;
  merged.last_walk_seconds = costs.last_walk_seconds;
  for (const Share& share : shares) {
    // A range of numbers is sent as one task; if results are stored, one receipt is returned.
    TaskCost& sum = merged.tasks.emplace_back(costs.tasks[share.front()]);
    for (const std::size_t number : std::span(share).subspan(1)) {
      const TaskCost& task = costs.tasks[number];
      sum.work_seconds += task.work_seconds;
      sum.samples += task.samples;
      if (stored) continue;
      sum.accept_seconds += task.accept_seconds;
      sum.result_bytes += task.result_bytes;
    }
  }
  return merged;
}

bool ReplayedSource::next(Bytes& task) {
  if (before_ > 0.0) spend_(std::exchange(before_, 0.0));
  const auto number = next_number();
  if (!number) {
    spend_(costs_->last_walk_seconds);
    return false;
  }
  const TaskCost& cost = costs_->tasks[*number];
  spend_(cost.walk_seconds);
  put(static_cast<Number>(*number), cost.task_bytes, task);
  return true;
}

std::size_t ReplayedSource::parcel_size() const {
  return share_ < plan_.size() ? plan_[share_].size() : 0;
}

std::optional<std::size_t> ReplayedSource::next_number() {
  if (made_ == costs_->tasks.size()) return std::nullopt;
  const std::size_t made = made_++;
  if (plan_.empty()) return made;
  const Share& share = plan_[share_];
  const std::size_t number = share[place_];
  if (++place_ == share.size()) {
    ++share_;
    place_ = 0;
  }
  return number;
}

void ReplayedWorker::perform(std::span<const std::byte> task, Bytes& result, const Heartbeat&) {
  const Number number = number_in(task, *costs_);
  const TaskCost& cost = costs_->tasks[number];
  spend_(cost.work_seconds);
  put(number, cost.result_bytes, result);
}

std::size_t ReplayedSink::accept(std::span<const std::byte> result) {
  const Number number = number_in(result, *costs_);
  if (came_[number]) throw ProtocolError("a result arrived twice");
  came_[number] = true;
  spend_(costs_->tasks[number].accept_seconds);
  return costs_->tasks[number].samples;
}

}  // namespace beambench::cluster
